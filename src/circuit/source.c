/* source.c - independent sources V and I: a DC value and at most one function of time, AC magnitude and phase. */
#include "element_cards.h"
#include "pi.h"
#include "reader.h"

#include <math.h>
#include <string.h>

static const char USAGE[] =
    "a source is: Vname node node [DC value] [SIN, PULSE, PWL, EXP, AM or SFFM(...)]";

/* What a card says besides its nodes. */
struct source {
    enum dalcs_quantity quantity;
    struct dalcs_stimulus *stimulus;
    struct dalcs_parasitics parasitics;
    struct dalcs_current_limits limits;
    bool has_function, has_ac;
    double ac[2]; /* magnitude, V or A, and phase, degrees */
    bool is_load; /* an I that never delivers (LTspice) */
    int n_open;   /* brackets around a function, as ngspice has them: (PULSE 0 1) (AC 1) (5) */
};

static void set_ac(struct source *source) {
    const double angle = source->ac[1] * (dalcs_pi / 180.0);
    source->has_ac = true;
    source->stimulus->ac_real = source->ac[0] * cos(angle);
    source->stimulus->ac_imaginary = source->ac[0] * sin(angle);
}

/* AC [magnitude [phase in degrees]]; 1 and 0 when left out. False when an error was reported. */
static bool read_ac(struct dalcs_reader *reader, struct source *source) {
    double value[2] = {1.0, 0.0};
    dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    const bool is_open = dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
    for (int k = 0; k < 2; k++) {
        const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
        if (next == NULL || !dalcs_reader_is_number(next)) {
            break;
        }
        if (!dalcs_reader_list_number(reader, k == 0 ? source->quantity : DALCS_PLAIN, "a number",
                                      &value[k])) {
            return false;
        }
    }
    if (is_open && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        dalcs_reader_missing(reader, "')'");
        return false;
    }
    memcpy(source->ac, value, sizeof value);
    set_ac(source);
    return true;
}

/* ACMAG magnitude, as ngspice writes it, or ACPHASE degrees behind it or AC, as Qucs-S does: the other of the two stays. */
static bool read_ac_part(struct dalcs_reader *reader, const struct dalcs_token *word,
                         struct source *source) {
    const bool is_phase = strcmp(word->text, "acphase") == 0;
    dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    const bool is_open = dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
    if (!dalcs_reader_number(reader, is_phase ? DALCS_PLAIN : source->quantity,
                             is_phase ? "a phase in degrees" : "a magnitude",
                             &source->ac[is_phase])) {
        return false;
    }
    if (is_open && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        dalcs_reader_missing(reader, "')'");
        return false;
    }
    if (is_phase && !source->has_ac) {
        dalcs_builder_error(reader->builder, word, "AC 1 ACPHASE 90, or AC 1 90",
                            "ACPHASE stands behind AC and its magnitude");
        return false;
    }
    set_ac(source);
    return true;
}

static bool read_dc(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                    struct dalcs_stimulus *stimulus) {
    if (stimulus->has_dc) {
        const struct dalcs_token *second = dalcs_reader_peek(reader, 0);
        const char *unit = second != NULL ? strstr(second->text, "hz") : NULL;
        dalcs_builder_error(reader->builder,
                            second != NULL ? second : dalcs_reader_previous(reader),
                            unit != NULL ? "SIN(0 325 50) is a sine of 230 V rms and 50 Hz" : USAGE,
                            "a second DC value");
        return false;
    }
    stimulus->has_dc = true;
    return dalcs_reader_number(reader, quantity, "a value", &stimulus->dc);
}

/* A word that is neither DC, AC nor the name of a function. */
static void report_word(struct dalcs_reader *reader, const struct dalcs_token *token) {
    static const struct {
        const char *name, *hint;
    } later[] = {
        {"trnoise", NULL},
        {"trrandom", NULL},
        {"port", NULL},
        {"value", NULL},
        {"poly", NULL},
        {"table", NULL},
        {"laplace", NULL},
        {"wavefile", "write its samples as lines of time and value: PWL FILE=\"points.txt\""},
        {"trigger", "B with idt(1,0,v(a)<0.5) has the time since v(a) rose: "
                    "V=table(idt(1,0,v(a)<0.5), 0,0, 1m,1)"},
        {"step", "write the steps of a load as PWL(...)"},
    };

    static const char *const known[] = {"sin",  "pulse", "pwl", "exp",     "am",
                                        "sffm", "dc",    "ac",  "external"};
    struct dalcs_builder *builder = reader->builder;
    for (size_t k = 0; k < sizeof later / sizeof later[0]; k++) {
        if (strcmp(token->text, later[k].name) == 0) {
            dalcs_builder_error(builder, token, later[k].hint,
                                "'%s' on a source is not supported yet", token->text);
            return;
        }
    }
    const char *hint = dalcs_builder_suggest_of(builder, known, sizeof known / sizeof known[0],
                                                token->text, USAGE);
    const bool has_value = reader->at > 3; /* behind the name and two nodes */
    dalcs_builder_error(builder, token,
                        has_value ? dalcs_reader_unit_hint(reader, token, hint) : hint,
                        "'%s' is neither a value nor a source function", token->text);
}

/* Rser= or Cpar= of a V. */
static bool takes_parasitic(struct dalcs_reader *reader, enum dalcs_quantity quantity) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    return quantity == DALCS_VOLTAGE &&
           (strcmp(token->text, "rser") == 0 || strcmp(token->text, "cpar") == 0) &&
           dalcs_reader_take_parameter(reader) != NULL;
}

/* Ilimit= or revIlimit= of a V. */
static bool takes_limit(struct dalcs_reader *reader, enum dalcs_quantity quantity) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    return quantity == DALCS_VOLTAGE && dalcs_current_limit_is_name(token->text) &&
           dalcs_reader_take_parameter(reader) != NULL;
}

/* DISTOF1 and DISTOF2, a magnitude and a phase, which only .disto reads. */
static bool skips_distortion(struct dalcs_reader *reader) {
    const bool skips =
        dalcs_reader_take_word(reader, "distof1") || dalcs_reader_take_word(reader, "distof2");
    (void)(skips && dalcs_reader_take(reader, DALCS_TOKEN_EQUAL));
    for (int k = 0; skips && k < 2 && !dalcs_reader_at_end(reader) &&
                    dalcs_reader_is_number(dalcs_reader_peek(reader, 0));
         k++) {
        reader->at++;
    }
    return skips;
}

/* SIN, PULSE, ... */
static bool is_function(const struct dalcs_token *token) {
    return token != NULL && token->kind == DALCS_TOKEN_WORD &&
           dalcs_waveform_card_is_name(token->text);
}

/* The opening bracket before a function's name, DC, AC or a value alone, or the closing one. */
static bool takes_bracket(struct dalcs_reader *reader, struct source *source) {
    const struct dalcs_token *next = dalcs_reader_peek(reader, 1);
    const bool is_named =
        next != NULL && next->kind == DALCS_TOKEN_WORD &&
        (is_function(next) || strcmp(next->text, "dc") == 0 || strcmp(next->text, "ac") == 0);
    const struct dalcs_token *close = dalcs_reader_peek(reader, 2);
    const bool is_value = next != NULL && dalcs_reader_is_number(next) && close != NULL &&
                          close->kind == DALCS_TOKEN_CLOSE;
    if ((is_named || is_value) && dalcs_reader_take(reader, DALCS_TOKEN_OPEN)) {
        source->n_open++;
        return true;
    }
    if (source->n_open > 0 && dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        source->n_open--;
        return true;
    }
    return false;
}

static bool read_function(struct dalcs_reader *reader, struct source *source) {
    if (source->has_function) {
        dalcs_builder_error(reader->builder, dalcs_reader_peek(reader, 0), NULL,
                            "a second source function");
        return false;
    }
    source->has_function = true;
    return dalcs_waveform_card_parse(reader, source->quantity, source->stimulus);
}

/* The next of what a card says; false when an error was reported. */
static bool read_item(struct dalcs_reader *reader, struct source *source) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    const enum dalcs_quantity quantity = source->quantity;
    if (dalcs_reader_take_word(reader, "dc")) {
        dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
        /* DC PWL(...), as ngspice takes it: no value of its own */
        return is_function(dalcs_reader_peek(reader, 0)) ||
               read_dc(reader, quantity, source->stimulus);
    }
    if (takes_parasitic(reader, quantity)) {
        return dalcs_parasitic_read(reader, token, &source->parasitics);
    }
    if (takes_limit(reader, quantity)) {
        return dalcs_current_limit_read(reader, token, &source->limits);
    }
    if (dalcs_reader_take_word(reader, "ac")) {
        return read_ac(reader, source);
    }
    if (dalcs_reader_take_word(reader, "acmag") || dalcs_reader_take_word(reader, "acphase")) {
        return read_ac_part(reader, token, source);
    }
    if (!source->has_function && dalcs_reader_take_word(reader, "external")) {
        source->has_function = source->stimulus->is_external = true;
        return true;
    }
    if (quantity == DALCS_CURRENT && dalcs_reader_take_word(reader, "load")) {
        source->is_load = true;
        return true;
    }
    if (skips_distortion(reader) || takes_bracket(reader, source)) {
        return true;
    }
    if (is_function(token)) {
        return read_function(reader, source);
    }
    if (dalcs_reader_is_number(token)) {
        return read_dc(reader, quantity, source->stimulus);
    }
    if (token->kind == DALCS_TOKEN_WORD) {
        report_word(reader, token);
    } else {
        dalcs_reader_unexpected(reader);
    }
    return false;
}

static void read_source(struct dalcs_reader *reader, struct source *source) {
    while (!dalcs_reader_at_end(reader)) {
        if (!read_item(reader, source)) {
            return;
        }
    }
    if (source->n_open > 0) {
        dalcs_reader_missing(reader, "')'");
        return;
    }
    if (!source->stimulus->has_dc && !source->has_function) {
        source->stimulus->has_dc = true;
        source->stimulus->is_ac_alone = source->has_ac;
        if (source->has_ac) {
            return; /* a source for .ac: 0 is meant */
        }
        dalcs_builder_warn(reader->builder, reader->card->token, NULL,
                           "source '%s' has no value: it is 0", reader->card->token->text);
    }
}

/* m sources in parallel. */
static void multiply(struct dalcs_builder *builder, struct source *source, double m) {
    if (source->quantity == DALCS_CURRENT) {
        dalcs_parallel_scale(builder, source->stimulus, m);
    }
    dalcs_parasitic_multiply(&source->parasitics, m);
    source->limits.forward *= m;
    source->limits.reverse *= m;
}

/* What a program outside gives, which is not known yet: for the time being its DC value. */
static void make_external(struct dalcs_builder *builder, const struct dalcs_card *card,
                          struct dalcs_stimulus *s) {
    double *point = dalcs_arena_alloc(&builder->circuit->arena, 2, sizeof *point);
    if (point == NULL) {
        builder->out_of_memory = true;
        return;
    }
    if (card->parallel > 0) {
        dalcs_builder_error(
            builder, card->token, "several cards",
            "an external source cannot be several in parallel, which m= makes of it");
    }
    point[1] = s->dc;
    s->has_dc = true;
    s->is_written = true;
    s->kind = DALCS_STIMULUS_PWL;
    s->u.pwl.n = 1;
    s->u.pwl.t = point;
    s->u.pwl.v = point + 1;
    s->u.pwl.repeats = false;
    builder->circuit->control.n_externals++;
}

void dalcs_source_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                        enum dalcs_device_kind kind) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_device *device = dalcs_builder_add_device(builder, kind, card->token);
    if (device == NULL || !dalcs_reader_nodes(&reader, 2, device->node)) {
        return;
    }
    device->stimulus = circuit->n_stimuli++;
    struct source source = {.quantity = kind == DALCS_VSOURCE ? DALCS_VOLTAGE : DALCS_CURRENT,
                            .stimulus = &circuit->stimulus[device->stimulus],
                            .limits = {INFINITY, INFINITY}};
    read_source(&reader, &source);
    if (source.stimulus->is_external) {
        make_external(builder, card, source.stimulus);
    }
    if (card->parallel > 0) {
        multiply(builder, &source, card->parallel);
    }
    dalcs_parasitic_expand(builder, card->token, device, &source.parasitics);
    dalcs_current_limit_expand(builder, card->token, device, &source.limits);
    if (source.is_load) {
        dalcs_current_limit_make_load(builder, card->token, device);
    }
}
