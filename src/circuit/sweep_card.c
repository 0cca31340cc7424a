/* sweep_card.c - .dc, .ac and .step: what is swept, and over which values.
 *
 *     .dc source start stop step [source start stop step]
 *     .ac dec|oct|lin points start stop
 *     .step [lin|dec|oct] item start stop step, .step item list value ..., .step item file=name
 *
 * An item is an element, `param name`, a model's parameter `D name(parameter)` or `temp`. The first
 * sweep is the innermost. */
#include "analysis_cards.h"
#include "number_file.h"
#include "reader.h"

#include <stdlib.h>
#include <string.h>

static const char DC_USAGE[] =
    ".dc [lin|dec|oct] source start stop step [source start stop step], .dc source list value ...";
static const char AC_USAGE[] = ".ac dec|oct|lin points fstart fstop, or .ac list frequency ...";
static const char STEP_USAGE[] =
    ".step [lin|dec|oct] item start stop step; .step item list value value ...; .step item "
    "file=name; an item is an "
    "element, param name, D model(parameter) or temp";

enum { MOST_NESTED = 8 };

static const char *keep_text(struct dalcs_builder *builder, const char *text) {
    const char *copy = dalcs_arena_copy(&builder->circuit->arena, text, strlen(text));
    builder->out_of_memory = builder->out_of_memory || copy == NULL;
    return copy;
}

/* ---- What is swept --------------------------------------------------------------------------- */

static bool set_element(struct dalcs_builder *builder, const struct dalcs_token *token,
                        const char *letters, struct dalcs_sweep *sweep) {
    const int device = dalcs_builder_find_device(builder, token);
    if (device < 0) {
        return false;
    }
    const struct dalcs_device *d = &builder->circuit->device[device];
    if (strchr(letters, d->letter) == NULL) {
        dalcs_builder_error(builder, token, NULL, "'%s' is %s: it has no value to sweep here",
                            token->text, dalcs_builder_kind_text(d->kind));
        return false;
    }
    sweep->target = DALCS_SWEEP_ELEMENT;
    sweep->device = device;
    sweep->name = sweep->label = d->name;
    return true;
}

static bool set_parameter(struct dalcs_builder *builder, const struct dalcs_token *token,
                          struct dalcs_sweep *sweep) {
    if (!dalcs_deck_has_parameter(builder->deck, token->text)) {
        const char *nearest = dalcs_deck_nearest_parameter(builder->deck, token->text);
        dalcs_builder_error(
            builder, token,
            nearest != NULL ? dalcs_builder_hint(builder, "did you mean '%s'?", nearest) : NULL,
            "there is no parameter '%s'", token->text);
        return false;
    }
    if (builder->deck->n_drawn == 0 && !dalcs_deck_uses_parameter(builder->deck, token->text)) {
        const char *nearest = dalcs_deck_nearest_parameter(builder->deck, token->text);
        const bool is_other = nearest != NULL && strcmp(nearest, token->text) != 0;
        dalcs_builder_warn(builder, token,
                           is_other ? dalcs_builder_hint(builder, "did you mean '%s'?", nearest)
                                    : NULL,
                           "nothing uses the parameter '%s'", token->text);
    }
    sweep->target = DALCS_SWEEP_PARAMETER;
    sweep->name = sweep->label = keep_text(builder, token->text);
    return true;
}

static void set_temperature(struct dalcs_builder *builder, const struct dalcs_token *token,
                            struct dalcs_sweep *sweep) {
    sweep->target = DALCS_SWEEP_TEMPERATURE;
    sweep->name = sweep->label = "temp";
    dalcs_builder_note(builder, token, NULL,
                       "R, L and C with tc1= or tc2=, and formulas with temp, follow the "
                       "temperature, and nothing else");
}

static bool set_model(struct dalcs_builder *builder, const struct dalcs_token *model,
                      const char *field, struct dalcs_sweep *sweep) {
    if (dalcs_names_find(&builder->models.names, model->text) < 0) {
        dalcs_builder_error(
            builder, model,
            dalcs_builder_suggest(builder, &builder->models.names, model->text, "models"),
            "there is no model '%s'", model->text);
        return false;
    }
    sweep->target = DALCS_SWEEP_MODEL;
    sweep->name = keep_text(builder, model->text);
    sweep->field = keep_text(builder, field);
    sweep->label = dalcs_arena_printf(&builder->circuit->arena, "%s(%s)", model->text, field);
    builder->out_of_memory = builder->out_of_memory || sweep->label == NULL;
    return true;
}

/* The next two or three tokens: `name ( parameter )`, after the type of the model if that is there; an element's name
 * is none. */
static bool is_model(const struct dalcs_reader *reader, int *at) {
    const struct dalcs_token *first = dalcs_reader_peek(reader, 0);
    const bool is_element = dalcs_names_find(&reader->builder->elements.devices, first->text) >= 0;
    for (*at = 0; *at <= (is_element ? 0 : 1); ++*at) {
        const struct dalcs_token *word = dalcs_reader_peek(reader, *at);
        const struct dalcs_token *open = dalcs_reader_peek(reader, *at + 1);
        const struct dalcs_token *field = dalcs_reader_peek(reader, *at + 2);
        const struct dalcs_token *close = dalcs_reader_peek(reader, *at + 3);
        if (close != NULL && word->kind == DALCS_TOKEN_WORD && open->kind == DALCS_TOKEN_OPEN &&
            field->kind == DALCS_TOKEN_WORD && close->kind == DALCS_TOKEN_CLOSE) {
            return true;
        }
    }
    return false;
}

/* The item of a .step, or the source of a .dc; letters: of the elements that may be swept. */
bool dalcs_sweep_read_item(struct dalcs_reader *reader, const char *letters,
                           struct dalcs_sweep *sweep) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    int at;
    sweep->device = -1;
    if (token == NULL || token->kind != DALCS_TOKEN_WORD) {
        dalcs_reader_missing(reader, "the item of the sweep");
        return false;
    }
    sweep->where = dalcs_builder_keep_location(builder, token);
    if (dalcs_reader_take_word(reader, "param") || dalcs_reader_take_word(reader, "param:")) {
        return dalcs_reader_name(reader, "the name of a parameter", &token) &&
               set_parameter(builder, token, sweep);
    }
    if (is_model(reader, &at)) {
        const struct dalcs_token *model = dalcs_reader_peek(reader, at);
        const struct dalcs_token *field = dalcs_reader_peek(reader, at + 2);
        reader->at += at + 4;
        return set_model(builder, model, field->text, sweep);
    }
    reader->at++;
    if (strcmp(token->text, "temp") == 0) {
        set_temperature(builder, token, sweep);
        return true;
    }
    if (dalcs_names_find(&builder->elements.devices, token->text) < 0 &&
        dalcs_deck_has_parameter(builder->deck, token->text)) {
        return set_parameter(builder, token, sweep);
    }
    return set_element(builder, token, letters, sweep);
}

/* ---- Its values ------------------------------------------------------------------------------ */

static enum dalcs_quantity quantity_of(const struct dalcs_builder *builder,
                                       const struct dalcs_sweep *sweep) {
    if (sweep->device < 0) {
        return DALCS_PLAIN;
    }
    switch (builder->circuit->device[sweep->device].letter) {
    case 'r':
        return DALCS_OHM;
    case 'c':
        return DALCS_FARAD;
    case 'v':
        return DALCS_VOLTAGE;
    case 'i':
        return DALCS_CURRENT;
    default:
        return DALCS_PLAIN;
    }
}

/* Counts the values from start to stop; place: of the start and of the step. */
static bool count(struct dalcs_builder *builder, const struct dalcs_token *const *place,
                  const char *usage, struct dalcs_sweep *sweep) {
    if (sweep->spacing == DALCS_LINEAR && sweep->step == 0.0 && sweep->start != sweep->stop) {
        dalcs_builder_error(builder, place[2], usage, "a step of 0 never reaches %g", sweep->stop);
        return false;
    }
    if (sweep->spacing != DALCS_LINEAR) {
        if (!(sweep->start > 0.0) || !(sweep->stop >= sweep->start)) {
            dalcs_builder_error(builder, sweep->start > 0.0 ? place[1] : place[0], usage,
                                "decades and octaves go from a positive value up to a larger one");
            return false;
        }
        if (!(sweep->step >= 1.0)) {
            dalcs_builder_error(builder, place[2], usage, "there must be at least 1 value in each");
            return false;
        }
    }
    sweep->n = dalcs_sweep_count(sweep->spacing, sweep->start, sweep->stop, sweep->step);
    if (sweep->n == 0) {
        dalcs_builder_error(
            builder, place[2], dalcs_builder_hint(builder, "write %g", -sweep->step),
            "a step of %g leads away from %g to %g", sweep->step, sweep->start, sweep->stop);
        return false;
    }
    if (sweep->n < 0) {
        dalcs_builder_error(builder, place[2], NULL, "these are more than %d values",
                            (int)DALCS_SWEEP_MOST);
        return false;
    }
    return true;
}

static bool read_range(struct dalcs_reader *reader, const char *usage, struct dalcs_sweep *sweep) {
    static const char *const what[] = {"a start", "a stop", "a step"};
    const enum dalcs_quantity quantity = quantity_of(reader->builder, sweep);
    const bool counts = sweep->spacing != DALCS_LINEAR;
    double *value[] = {&sweep->start, &sweep->stop, &sweep->step};
    const struct dalcs_token *place[3];
    for (int k = 0; k < 3; k++) {
        place[k] = dalcs_reader_peek(reader, 0);
        if (!dalcs_reader_list_number(reader, k == 2 && counts ? DALCS_PLAIN : quantity, what[k],
                                      value[k])) {
            return false;
        }
    }
    return count(reader->builder, place, usage, sweep);
}

static bool read_list(struct dalcs_reader *reader, struct dalcs_sweep *sweep) {
    const enum dalcs_quantity quantity = quantity_of(reader->builder, sweep);
    const size_t room = (size_t)(reader->card->n - reader->at);
    double *list = dalcs_arena_alloc(&reader->builder->circuit->arena, room, sizeof *list);
    if (list == NULL) {
        reader->builder->out_of_memory = true;
        return false;
    }
    do {
        if (!dalcs_reader_list_number(reader, quantity, "a value", &list[sweep->n])) {
            return false;
        }
        sweep->n++;
    } while (!dalcs_reader_at_end(reader));
    sweep->spacing = DALCS_LISTED;
    sweep->list = list;
    return true;
}

/* The values of a file, after the word FILE. */
static bool read_file(struct dalcs_reader *reader, struct dalcs_sweep *sweep) {
    struct dalcs_builder *builder = reader->builder;
    struct dalcs_number_file file;
    dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    const struct dalcs_token *name = dalcs_reader_peek(reader, 0);
    if (name == NULL || (name->kind != DALCS_TOKEN_WORD && name->kind != DALCS_TOKEN_STRING)) {
        dalcs_reader_missing(reader, "the name of a file");
        return false;
    }
    reader->at++;
    if (!dalcs_number_file_open(builder, name, "values", &file)) {
        return false;
    }
    double *list = NULL;
    size_t capacity = 0;
    double value;
    enum dalcs_status status = DALCS_OK;
    while (status == DALCS_OK && sweep->n <= DALCS_SWEEP_MOST &&
           dalcs_number_file_next(&file, &value)) {
        status = dalcs_grow(&list, &capacity, (size_t)sweep->n + 1, sizeof *list);
        if (status == DALCS_OK) {
            list[sweep->n++] = value;
        }
    }
    bool ok = status == DALCS_OK && dalcs_number_file_is_read(builder, name, &file,
                                                              "the values, with blanks or lines "
                                                              "between them");
    if (ok && sweep->n == 0) {
        dalcs_builder_error(builder, name, NULL, "there are no values in %s", file.path);
        ok = false;
    }
    double *kept =
        ok ? dalcs_arena_alloc(&builder->circuit->arena, (size_t)sweep->n, sizeof *kept) : NULL;
    builder->out_of_memory = builder->out_of_memory || status != DALCS_OK || (ok && kept == NULL);
    if (kept != NULL) {
        memcpy(kept, list, (size_t)sweep->n * sizeof *kept);
    }
    free(list);
    dalcs_number_file_close(&file);
    sweep->spacing = DALCS_LISTED;
    sweep->list = kept;
    return kept != NULL;
}

static bool take_spacing(struct dalcs_reader *reader, enum dalcs_spacing *spacing) {
    if (dalcs_reader_take_word(reader, "lin")) {
        *spacing = DALCS_LINEAR;
    } else if (dalcs_reader_take_word(reader, "dec")) {
        *spacing = DALCS_DECADES;
    } else if (dalcs_reader_take_word(reader, "oct")) {
        *spacing = DALCS_OCTAVES;
    } else {
        return false;
    }
    return true;
}

/* ---- The cards ------------------------------------------------------------------------------- */

void dalcs_sweep_parse_dc(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, DC_USAGE);
    if (!dalcs_analysis_is_first(builder, card, &builder->analyses.dc)) {
        return;
    }
    int n = 0;
    do {
        struct dalcs_sweep *sweep = &circuit->dc[n];
        const bool is_spaced = take_spacing(&reader, &sweep->spacing);
        if (!dalcs_sweep_read_item(&reader, "vir", sweep)) {
            return;
        }
        const bool is_list = !is_spaced && dalcs_reader_take_word(&reader, "list");
        (void)take_spacing(&reader, &sweep->spacing);
        if (is_list ? !read_list(&reader, sweep) : !read_range(&reader, DC_USAGE, sweep)) {
            return;
        }
        n++;
    } while (!dalcs_reader_at_end(&reader) && n < DALCS_MOST_DC);
    if (!dalcs_reader_end(&reader)) {
        return;
    }
    if (n == 2 && strcmp(circuit->dc[0].label, circuit->dc[1].label) == 0) {
        dalcs_builder_error(builder, card->token, DC_USAGE, "both sweeps are of '%s'",
                            circuit->dc[0].label);
        return;
    }
    circuit->n_dc = n;
}

/* .ac list f1 f2 ..., as in LTspice, in any order. */
static void read_frequencies(struct dalcs_reader *reader, struct dalcs_sweep *f) {
    dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    const int first = reader->at;
    if (dalcs_reader_at_end(reader)) {
        dalcs_reader_missing(reader, "a frequency");
        return;
    }
    if (!read_list(reader, f)) {
        f->n = 0;
        return;
    }
    for (int k = 0; k < f->n; k++) {
        if (!(f->list[k] >= 0.0)) {
            dalcs_builder_error(reader->builder, &reader->card->token[first + k], AC_USAGE,
                                "a frequency cannot be negative");
            f->n = 0;
            return;
        }
    }
    f->start = f->list[0];
    f->stop = f->list[f->n - 1];
}

static bool read_loop(struct dalcs_reader *reader) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *name;
    if (!dalcs_reader_name(reader, "a voltage source", &name)) {
        return false;
    }
    builder->circuit->orbit_ac.loop = keep_text(builder, name->text);
    return true;
}

/* voltage or both */
static bool read_injection(struct dalcs_reader *reader) {
    bool *is_loaded = &reader->builder->circuit->orbit_ac.is_loaded;
    *is_loaded = dalcs_reader_take_word(reader, "both");
    if (*is_loaded || dalcs_reader_take_word(reader, "voltage")) {
        return true;
    }
    dalcs_reader_missing(reader, "'voltage' or 'both'");
    return false;
}

static bool read_sideband(struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    double value;
    if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a number", &value)) {
        return false;
    }
    if (!(value >= -DALCS_MOST_SIDEBAND && value <= DALCS_MOST_SIDEBAND) ||
        value != (double)(int)value) {
        dalcs_builder_error(reader->builder, token, AC_USAGE,
                            "a sideband is a whole number, at most %d of them away",
                            (int)DALCS_MOST_SIDEBAND);
        return false;
    }
    reader->builder->circuit->orbit_ac.sideband = (int)value;
    return true;
}

/* loop=NAME, injection=voltage|both, sideband=K, or nothing more. False after a message. */
static bool read_orbit_words(struct dalcs_reader *reader) {
    for (bool ok = true; ok;) {
        const bool is_loop = dalcs_reader_take_word(reader, "loop");
        const bool is_injection = !is_loop && dalcs_reader_take_word(reader, "injection");
        if (!is_loop && !is_injection && !dalcs_reader_take_word(reader, "sideband")) {
            return true;
        }
        if (!dalcs_reader_take(reader, DALCS_TOKEN_EQUAL)) {
            dalcs_reader_missing(reader, "'='");
            return false;
        }
        ok = is_loop        ? read_loop(reader)
             : is_injection ? read_injection(reader)
                            : read_sideband(reader);
    }
    return false;
}

void dalcs_sweep_parse_ac(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_sweep *f = &builder->circuit->ac;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, AC_USAGE);
    if (!dalcs_analysis_is_first(builder, card, &builder->analyses.ac)) {
        return;
    }
    f->where = dalcs_builder_keep_location(builder, card->token);
    f->name = f->label = "frequency";
    f->device = -1;
    if (!read_orbit_words(&reader)) {
        return;
    }
    if (dalcs_reader_take_word(&reader, "list")) {
        read_frequencies(&reader, f);
        return;
    }
    if (!take_spacing(&reader, &f->spacing)) {
        dalcs_reader_missing(&reader, "dec, oct, lin or list");
        return;
    }
    const struct dalcs_token *points = dalcs_reader_peek(&reader, 0);
    double n;
    if (!dalcs_reader_list_number(&reader, DALCS_PLAIN, "a number of points", &n)) {
        return;
    }
    const struct dalcs_token *start = dalcs_reader_peek(&reader, 0);
    if (!dalcs_reader_list_number(&reader, DALCS_HERTZ, "a frequency", &f->start)) {
        return;
    }
    const struct dalcs_token *stop = dalcs_reader_peek(&reader, 0);
    if (!dalcs_reader_list_number(&reader, DALCS_HERTZ, "a frequency", &f->stop) ||
        !read_orbit_words(&reader) || !dalcs_reader_end(&reader)) {
        return;
    }
    if (!(n >= 1.0) || n != (double)(long)n || n > DALCS_SWEEP_MOST) {
        dalcs_builder_error(builder, points, AC_USAGE,
                            "the number of points must be a whole number, at least 1");
        return;
    }
    const bool is_linear = f->spacing == DALCS_LINEAR;
    if (!(f->start > 0.0) && !(is_linear && f->start == 0.0)) {
        dalcs_builder_error(builder, start, AC_USAGE, "the first frequency must be positive");
        return;
    }
    if (!(f->stop >= f->start)) {
        dalcs_builder_error(builder, stop, AC_USAGE,
                            "the last frequency must not be below the first");
        return;
    }
    if (is_linear) {
        f->n = f->start == f->stop ? 1 : (int)n;
        f->step = f->n > 1 ? (f->stop - f->start) / (f->n - 1) : 0.0;
        return;
    }
    f->step = n;
    if (count(builder, (const struct dalcs_token *const[]){start, stop, points}, AC_USAGE, f)) {
        return;
    }
    f->n = 0;
}

bool dalcs_sweep_add_step(struct dalcs_builder *builder, const struct dalcs_card *card,
                          const struct dalcs_sweep *sweep) {
    struct dalcs_circuit *circuit = builder->circuit;
    if (circuit->step == NULL) {
        circuit->step = dalcs_arena_alloc(&circuit->arena, MOST_NESTED, sizeof *circuit->step);
        builder->out_of_memory = builder->out_of_memory || circuit->step == NULL;
    }
    if (builder->out_of_memory) {
        return false;
    }
    if (circuit->n_steps == MOST_NESTED) {
        dalcs_builder_error(builder, card->token, NULL, "more than %d .step cards",
                            (int)MOST_NESTED);
        return false;
    }
    for (int k = 0; k < circuit->n_steps; k++) {
        if (strcmp(circuit->step[k].label, sweep->label) == 0) {
            dalcs_builder_error(builder, card->token, NULL, "a second %s of '%s'",
                                card->token->text, sweep->label);
            return false;
        }
    }
    circuit->step[circuit->n_steps++] = *sweep;
    return true;
}

void dalcs_sweep_parse_step(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, STEP_USAGE);
    struct dalcs_sweep sweep = {.spacing = DALCS_LINEAR};
    bool is_spaced = take_spacing(&reader, &sweep.spacing);
    if (!dalcs_sweep_read_item(&reader, "vircleghf", &sweep)) {
        return;
    }
    is_spaced = take_spacing(&reader, &sweep.spacing) || is_spaced;
    if (!is_spaced && dalcs_reader_take_word(&reader, "file")) {
        if (!read_file(&reader, &sweep) || !dalcs_reader_end(&reader)) {
            return;
        }
    } else if (!is_spaced && dalcs_reader_take_word(&reader, "list")) {
        dalcs_reader_take(&reader, DALCS_TOKEN_EQUAL);
        if (!read_list(&reader, &sweep)) {
            return;
        }
    } else if (!read_range(&reader, STEP_USAGE, &sweep) || !dalcs_reader_end(&reader)) {
        return;
    }
    (void)dalcs_sweep_add_step(builder, card, &sweep);
}

void dalcs_sweep_check(struct dalcs_builder *builder) {
    const struct dalcs_circuit *circuit = builder->circuit;
    long total = 1;
    for (int k = 0; k < circuit->n_steps; k++) {
        const int device = circuit->step[k].device;
        const int stimulus = device >= 0 ? circuit->device[device].stimulus : -1;
        if (stimulus >= 0 && circuit->stimulus[stimulus].kind != DALCS_STIMULUS_DC &&
            circuit->transient.present) {
            dalcs_builder_warn_at(
                builder, &circuit->step[k].where, "put a parameter into the function and step that",
                "this steps the DC value of '%s'; .tran uses its function", circuit->step[k].name);
        }
        total *= circuit->step[k].n;
        if (total > DALCS_SWEEP_MOST) {
            dalcs_builder_error_at(builder, &circuit->step[k].where, NULL,
                                   "these are more than %d steps", (int)DALCS_SWEEP_MOST);
            return;
        }
    }
    bool has_ac = circuit->ac.n == 0 || circuit->orbit_ac.loop != NULL;
    for (int k = 0; k < circuit->n_stimuli && !has_ac; k++) {
        has_ac = circuit->stimulus[k].ac_real != 0.0 || circuit->stimulus[k].ac_imaginary != 0.0;
    }
    if (!has_ac) {
        dalcs_builder_error_at(
            builder, &circuit->ac.where,
            "write AC 1 on the source that drives it, such as: V1 in 0 DC 5 AC 1",
            ".ac without a source that has an AC value: everything would be 0");
    }
}
