/* options.c - .options cards.
 *
 * Options of other simulators that steer what does not exist here are accepted with a note each, so
 * that netlists need no change; a name that no simulator knows is probably a spelling mistake, and
 * silently ignoring those has cost people days. */

#include "analysis_cards.h"
#include "lower_case.h"
#include "reader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Known here. */
static const char *const OURS[] = {
    "reltol", "abstol",   "vntol",        "method",   "step",    "stages", "fill",
    "curve",  "compress", "diodecurrent", "filetype", "dialect", "interp", "initial_interval",
    "bjt",    "seed",     "savecurrents", "temp",     "tnom"};

static const char *const FOREIGN[] = {
    "itl1",       "itl2",         "itl3",       "itl4",       "itl5",          "itl6",
    "gmin",       "trtol",        "chgtol",     "pivtol",     "pivrel",        "maxord",
    "numdgt",     "acct",         "noacct",     "list",       "nomod",         "nopage",
    "node",       "opts",         "noopts",     "noinit",     "klu",           "sparse",
    "cshunt",     "rshunt",       "gshunt",     "gfarad",     "gminsteps",     "srcsteps",
    "defl",       "defw",         "defad",      "defas",      "defpd",         "defps",
    "scale",      "plotwinsize",  "ramptime",   "ramptol",    "trytocompact",  "keepopinfo",
    "advconv",    "autostop",     "bypass",     "lvltim",     "limpts",        "cptime",
    "limtim",     "maxstep",      "mindiv",     "maxevtiter", "noopiter",      "noopalter",
    "sollim",     "xmu",          "mu",         "measdgt",    "topologycheck", "fastaccess",
    "nonlin",     "oldlimit",     "badmos3",    "minbreak",   "convstep",      "convabsstep",
    "dgmin",      "gdsmin",       "delmax",     "absdv",      "reldv",         "mxsolve",
    "ingold",     "post",         "probe",      "csdf",       "brief",         "co",
    "width",      "seedinfo",     "sim",        "digits",     "accurate",      "runlvl",
    "rawfile",    "ibisdc",       "warn",       "stepgmin",   "ptrantau",      "ptranmax",
    "skipgmin",   "solver",       "altinit",    "gear",       "trap",          "newtol",
    "nopointtol", "nomarch",      "thev_induc", "baudrate",   "ascii",         "meascplxfmt",
    "flagloads",  "mindeltagmin", "dptran",     "timeint",    "parser",        "output",
    "device",     "linsol"};

enum { N_OURS = sizeof OURS / sizeof OURS[0], N_FOREIGN = sizeof FOREIGN / sizeof FOREIGN[0] };

static void report_unknown(struct dalcs_builder *builder, const struct dalcs_token *name) {
    const char *hint = dalcs_builder_suggest_of(builder, OURS, N_OURS, name->text, NULL);
    if (hint == NULL) {
        hint = dalcs_builder_suggest_of(builder, FOREIGN, N_FOREIGN, name->text, NULL);
    }
    dalcs_builder_warn(builder, name, hint, "unknown option '%s' is ignored", name->text);
}

static bool read_positive(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                          double *value) {
    double given;
    if (!dalcs_reader_number(reader, quantity, "a value", &given)) {
        return false;
    }
    if (given <= 0) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "this option must be positive");
        return false;
    }
    *value = given;
    return true;
}

/* The tolerance of the methods that control their error. */
static bool read_tolerance(struct dalcs_reader *reader, double *value) {
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "a value", value)) {
        return false;
    }
    if (*value > DALCS_TOLERANCE_MAX && *value < 1) {
        dalcs_builder_note(reader->builder, dalcs_reader_previous(reader), NULL,
                           "a tolerance of %g is cut to %g", *value, DALCS_TOLERANCE_MAX);
        *value = DALCS_TOLERANCE_MAX;
    }
    if (*value < DALCS_TOLERANCE_MIN || *value > DALCS_TOLERANCE_MAX) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "reltol must lie between %g and %g", DALCS_TOLERANCE_MIN,
                            DALCS_TOLERANCE_MAX);
        return false;
    }
    return true;
}

static bool read_stages(struct dalcs_reader *reader, int *stages) {
    double value;
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "a number of stages", &value)) {
        return false;
    }
    if (!DALCS_HAS_STAGES(value)) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "stages must be 1, 3, 5, 7 or 9");
        return false;
    }
    *stages = (int)value;
    return true;
}

static bool read_compress(struct dalcs_reader *reader, struct dalcs_circuit_options *options) {
    double value;
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "a value", &value)) {
        return false;
    }
    const struct dalcs_token *place = dalcs_reader_previous(reader);
    if (value <= 0 || value >= 1) {
        dalcs_builder_error(reader->builder, place, NULL,
                            "compress must be greater than 0 and less than 1");
        return false;
    }
    options->compress = value;
    options->compress_where = dalcs_builder_keep_location(reader->builder, place);
    return true;
}

/* A bound, or none. */
static bool read_fill(struct dalcs_reader *reader, struct dalcs_circuit_options *options) {
    double value = INFINITY;
    const struct dalcs_token *place = dalcs_reader_peek(reader, 0);
    if (place != NULL && strcmp(place->text, "none") == 0) {
        reader->at++;
    } else if (!dalcs_reader_number(reader, DALCS_PLAIN, "a value or none", &value)) {
        return false;
    } else if (value <= 0 || value >= 1) {
        dalcs_builder_error(reader->builder, place, NULL,
                            "fill must be greater than 0 and less than 1, or none");
        return false;
    }
    options->fill = value;
    options->fill_where =
        dalcs_builder_keep_location(reader->builder, dalcs_reader_previous(reader));
    return true;
}

/* Xyce's distance of rows, which may be followed by pairs of a time and another one from there on. */
static bool read_interval(struct dalcs_reader *reader, double *value) {
    if (!read_positive(reader, DALCS_SECOND, value)) {
        return false;
    }
    const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
    if (next != NULL && dalcs_reader_is_number(next)) {
        dalcs_builder_note(reader->builder, next, NULL,
                           "the first interval counts from start to stop");
    }
    while (next != NULL && dalcs_reader_is_number(next)) {
        reader->at++;
        next = dalcs_reader_peek(reader, 0);
    }
    return true;
}

/* `one` or `other`: the former? */
static bool read_either(struct dalcs_reader *reader, const char *option, const char *one,
                        const char *other, bool *is_one) {
    char either[64];
    const struct dalcs_token *word;
    (void)snprintf(either, sizeof either, "%s or %s", one, other);
    if (!dalcs_reader_name(reader, either, &word)) {
        return false;
    }
    *is_one = strcmp(word->text, one) == 0;
    if (!*is_one && strcmp(word->text, other) != 0) {
        dalcs_builder_error(reader->builder, word, NULL, "%s is %s", option, either);
        return false;
    }
    return true;
}

static bool read_method(struct dalcs_reader *reader) {
    static const char *const theirs[] = {"trap", "trapezoidal", "gear", "bdf"};
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *method = dalcs_reader_peek(reader, 0);
    if (method != NULL && method->kind == DALCS_TOKEN_STRING) { /* LTspice: method="gear" */
        reader->at++;
    } else if (!dalcs_reader_name(reader, "the name of a method", &method)) {
        return false;
    }
    char *name = dalcs_arena_copy(&builder->circuit->arena, method->text, strlen(method->text));
    if (name == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    if (dalcs_builder_is_one_of(dalcs_lower_text(name), theirs, sizeof theirs / sizeof theirs[0])) {
        dalcs_builder_note(builder, method, NULL, "method '%s' of other simulators is ignored",
                           method->text);
        return true;
    }
    struct dalcs_circuit_options *options = &builder->circuit->options;
    options->method = name;
    options->method_where = dalcs_builder_keep_location(builder, method);
    return true;
}

/* Is it one whose value is a number? *ok: that could be read. */
static bool read_numeric(struct dalcs_reader *reader, const char *name, bool *ok) {
    struct dalcs_circuit_options *options = &reader->builder->circuit->options;
    if (strcmp(name, "reltol") == 0) {
        *ok = read_tolerance(reader, &options->reltol);
        return true;
    }
    if (strcmp(name, "abstol") == 0) {
        *ok = read_positive(reader, DALCS_CURRENT, &options->abstol);
        return true;
    }
    if (strcmp(name, "vntol") == 0) {
        *ok = read_positive(reader, DALCS_VOLTAGE, &options->vntol);
        return true;
    }
    if (strcmp(name, "step") == 0) {
        *ok = read_positive(reader, DALCS_SECOND, &options->step);
        return true;
    }
    if (strcmp(name, "initial_interval") == 0) {
        *ok = read_interval(reader, &options->initial_interval);
        return true;
    }
    if (strcmp(name, "stages") == 0) {
        *ok = read_stages(reader, &options->stages);
        return true;
    }
    if (strcmp(name, "fill") == 0) {
        *ok = read_fill(reader, options);
        return true;
    }
    if (strcmp(name, "compress") == 0) {
        *ok = read_compress(reader, options);
        return true;
    }
    return false;
}

/* The value of a known option; `=` is optional, as in SPICE. */
static bool read_ours(struct dalcs_reader *reader, const struct dalcs_token *token) {
    struct dalcs_circuit_options *options = &reader->builder->circuit->options;
    const char *name = token->text;
    if (strcmp(name, "interp") == 0) { /* ngspice's: rows at multiples of tstep alone */
        options->fill = INFINITY;
        options->fill_where = dalcs_builder_keep_location(reader->builder, token);
        return true;
    }
    if (strcmp(name, "savecurrents") == 0) { /* likewise: all currents besides what is recorded */
        reader->builder->signals.saves_currents = true;
        return true;
    }
    dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    if (strstr(name, "tol") != NULL && options->tolerance_where.line == 0) {
        options->tolerance_where = dalcs_builder_keep_location(reader->builder, token);
    }
    bool ok;
    if (read_numeric(reader, name, &ok)) {
        return ok;
    }
    if (strcmp(name, "diodecurrent") == 0) {
        options->has_diode_current = true;
        return read_positive(reader, DALCS_CURRENT, &reader->builder->models.diode_current);
    }
    if (strcmp(name, "bjt") == 0) {
        return read_either(reader, name, "switch", "refuse",
                           &reader->builder->models.bipolar_is_switch);
    }
    if (strcmp(name, "seed") == 0) {
        return dalcs_monte_carlo_read_seed(reader);
    }
    if (strcmp(name, "temp") == 0 || strcmp(name, "tnom") == 0) {
        return dalcs_temperature_read_option(reader, token);
    }
    if (strcmp(name, "curve") == 0) {
        return read_either(reader, name, "lines", "cubics", &options->lines);
    }
    if (strcmp(name, "filetype") == 0) {
        return read_either(reader, name, "ascii", "binary", &options->ascii);
    }
    if (strcmp(name, "dialect") == 0) {
        const struct dalcs_token *read_before; /* by dalcs_dialect_settle */
        return dalcs_reader_name(reader, "the name of a dialect", &read_before);
    }
    return read_method(reader);
}

void dalcs_options_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader =
        dalcs_reader_start(builder, card, ".options name=value name=value ...");
    while (!dalcs_reader_at_end(&reader)) {
        const struct dalcs_token *name;
        if (!dalcs_reader_name(&reader, "the name of an option", &name)) {
            return;
        }
        if (dalcs_builder_is_one_of(name->text, OURS, N_OURS)) {
            if (!read_ours(&reader, name)) {
                return;
            }
            continue;
        }
        if (dalcs_builder_is_one_of(name->text, FOREIGN, N_FOREIGN)) {
            dalcs_builder_note(builder, name, NULL, "option '%s' has no meaning here", name->text);
        } else {
            report_unknown(builder, name);
        }
        const struct dalcs_token *value = dalcs_reader_peek(&reader, 0);
        const bool has_value = dalcs_reader_take(&reader, DALCS_TOKEN_EQUAL) ||
                               (value != NULL && dalcs_reader_is_number(value));
        reader.at += has_value && !dalcs_reader_at_end(&reader);
    }
}
