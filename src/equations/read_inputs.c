/* read_inputs.c - `input` cards: source functions, and formulas of them. */
#include "element_cards.h"
#include "reader.h"
#include "reading.h"

#include <string.h>

/* TONES(offset delay amplitude frequency phase ...), into which AM and SFFM have been expanded. */
static bool read_tones(struct dalcs_reader *reader, struct dalcs_stimulus *s) {
    struct dalcs_tone tone[DALCS_STIMULUS_MOST_TERMS];
    int n = 0;
    reader->usage = "TONES(offset delay amplitude frequency cycles amplitude frequency ...)";
    bool opened = dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
    bool ok = dalcs_reader_list_number(reader, DALCS_PLAIN, "an offset", &s->u.tones.offset) &&
              dalcs_reader_list_number(reader, DALCS_PLAIN, "a delay", &s->u.tones.delay);
    while (ok && dalcs_reader_peek(reader, 0) != NULL &&
           dalcs_reader_is_number(dalcs_reader_peek(reader, 0)) && n < DALCS_STIMULUS_MOST_TERMS) {
        ok = dalcs_reader_list_number(reader, DALCS_PLAIN, "an amplitude", &tone[n].amplitude) &&
             dalcs_reader_list_number(reader, DALCS_PLAIN, "a frequency", &tone[n].frequency) &&
             dalcs_reader_list_number(reader, DALCS_PLAIN, "a phase in cycles", &tone[n].phase);
        n++;
    }
    if (!ok || (opened && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE))) {
        dalcs_reader_unexpected(reader);
        return false;
    }
    struct dalcs_tone *copy =
        dalcs_arena_alloc(&reader->builder->circuit->arena, (size_t)n, sizeof *copy);
    if (copy == NULL) {
        reader->builder->out_of_memory = true;
        return false;
    }
    memcpy(copy, tone, (size_t)n * sizeof *copy);
    s->kind = DALCS_STIMULUS_TONES;
    s->u.tones.n = n;
    s->u.tones.tone = copy;
    return true;
}

static bool read_function(struct dalcs_reader *reader, struct dalcs_stimulus *s, int depth);

/* Parts in formulas in formulas ... */
enum { DEEPEST_FORMULA = 64 };

/* factor (stimulus), up to the end. */
static bool read_parts(struct dalcs_reader *reader, struct dalcs_stimulus *s, int depth) {
    struct dalcs_arena *arena = &reader->builder->circuit->arena;
    const size_t most = (size_t)reader->card->n;
    struct dalcs_stimulus_summand *part = dalcs_arena_alloc(arena, most, sizeof *part);
    bool ok = part != NULL && depth < DEEPEST_FORMULA;
    int n_terms = 0;
    reader->builder->out_of_memory = reader->builder->out_of_memory || part == NULL;
    while (ok && dalcs_reader_peek(reader, 0) != NULL &&
           dalcs_reader_is_number(dalcs_reader_peek(reader, 0))) {
        struct dalcs_stimulus *of = dalcs_arena_alloc(arena, 1, sizeof *of);
        struct dalcs_stimulus_summand *next = &part[s->u.formula.argument.n++];
        reader->builder->out_of_memory = reader->builder->out_of_memory || of == NULL;
        next->of = of;
        ok = of != NULL &&
             dalcs_reader_list_number(reader, DALCS_PLAIN, "a factor", &next->factor) &&
             dalcs_reader_take(reader, DALCS_TOKEN_OPEN) && read_function(reader, of, depth + 1) &&
             dalcs_reader_take(reader, DALCS_TOKEN_CLOSE);
        n_terms += ok ? dalcs_stimulus_n_terms(of) : 0;
    }
    s->u.formula.argument.part = part;
    return ok && n_terms <= DALCS_STIMULUS_MOST_TERMS;
}

static bool read_knots(struct dalcs_reader *reader, struct dalcs_piecewise *f) {
    double n;
    if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a slope", &f->before) ||
        !dalcs_reader_list_number(reader, DALCS_PLAIN, "a slope", &f->after) ||
        !dalcs_reader_list_number(reader, DALCS_PLAIN, "a number of knots", &n) ||
        !(n >= 1.0 && 4.0 * n <= (double)reader->card->n)) {
        return false;
    }
    f->n = (int)n;
    f->knot = dalcs_arena_alloc(&reader->builder->circuit->arena, (size_t)f->n, sizeof *f->knot);
    bool ok = f->knot != NULL;
    reader->builder->out_of_memory = reader->builder->out_of_memory || !ok;
    for (int k = 0; k < f->n && ok; k++) {
        struct dalcs_knot *knot = &f->knot[k];
        double *const value[] = {&knot->at, &knot->left, &knot->value, &knot->right};
        for (int i = 0; i < 4 && ok; i++) {
            ok = dalcs_reader_list_number(reader, DALCS_PLAIN, "a number of a knot", value[i]);
        }
        ok = ok && (k == 0 || knot->at > knot[-1].at);
    }
    return ok;
}

/* FORMULA(before after knots, at left value right of each, constant, factor (stimulus) ...): what a formula of sources
 * alone puts out. */
static bool read_formula(struct dalcs_reader *reader, struct dalcs_stimulus *s, int depth) {
    reader->usage =
        "FORMULA(before after knots at left value right ... constant factor (function) ...)";
    s->kind = DALCS_STIMULUS_FORMULA;
    const bool ok = dalcs_reader_take(reader, DALCS_TOKEN_OPEN) &&
                    read_knots(reader, &s->u.formula.function) &&
                    dalcs_reader_list_number(reader, DALCS_PLAIN, "a constant",
                                             &s->u.formula.argument.constant) &&
                    read_parts(reader, s, depth) && dalcs_reader_take(reader, DALCS_TOKEN_CLOSE);
    if (!ok) {
        dalcs_reader_unexpected(reader);
    }
    return ok;
}

static bool is_closed(struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    return token != NULL && token->kind == DALCS_TOKEN_CLOSE;
}

/* input NAME [DC] [value] [function], or up to the parenthesis that closes a part of a formula */
static bool read_function(struct dalcs_reader *reader, struct dalcs_stimulus *s, int depth) {
    bool has_function = false;
    *s = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC};
    while (!dalcs_reader_at_end(reader) && !(depth > 0 && is_closed(reader))) {
        const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
        bool ok;
        if (!s->has_dc && (dalcs_reader_take_word(reader, "dc") || dalcs_reader_is_number(token))) {
            s->has_dc = true;
            ok = dalcs_reader_number(reader, DALCS_PLAIN, "a value", &s->dc);
        } else if (!has_function && dalcs_reader_take_word(reader, "tones")) {
            has_function = true;
            ok = read_tones(reader, s);
        } else if (!has_function && dalcs_reader_take_word(reader, "formula")) {
            has_function = true;
            ok = read_formula(reader, s, depth);
        } else if (!has_function && token->kind == DALCS_TOKEN_WORD &&
                   dalcs_waveform_card_is_name(token->text)) {
            has_function = true;
            ok = dalcs_waveform_card_parse(reader, DALCS_PLAIN, s);
        } else {
            dalcs_reader_unexpected(reader);
            ok = false;
        }
        if (!ok) {
            return false;
        }
    }
    if (!has_function && !s->has_dc) {
        dalcs_reader_missing(reader, "a value or a function: SIN, PULSE, PWL, EXP, AM or SFFM");
        return false;
    }
    return true;
}

static bool grow_inputs(struct dalcs_reading *r) {
    size_t capacity[3] = {r->input_capacity, r->input_capacity, r->input_capacity};
    bool ok = dalcs_grow(&r->input, &capacity[0], r->n_inputs + 1, sizeof *r->input) == DALCS_OK &&
              dalcs_grow(&r->input_name, &capacity[1], r->n_inputs + 1, sizeof *r->input_name) ==
                  DALCS_OK &&
              dalcs_grow(&r->input_token, &capacity[2], r->n_inputs + 1, sizeof *r->input_token) ==
                  DALCS_OK;
    r->input_capacity = ok ? capacity[2] : r->input_capacity;
    r->builder.out_of_memory = r->builder.out_of_memory || !ok;
    return ok;
}

void dalcs_reading_take_input(struct dalcs_reading *r, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(
        &r->builder, card, "input name value, or input name SIN(...), PULSE, PWL, EXP, AM, SFFM");
    struct dalcs_stimulus s;
    const char *name = dalcs_reading_name(&reader, "a name");
    if (r->n_systems > 0 || r->network != &r->description->network) {
        dalcs_builder_error(&r->builder, card->token, NULL, "inputs come before the systems");
        return;
    }
    for (size_t k = 0; k < r->n_inputs && name != NULL; k++) {
        if (strcmp(r->input_name[k], name) == 0) {
            dalcs_builder_error(&r->builder, card->token, NULL, "a second input '%s'", name);
            return;
        }
    }
    if (name != NULL && read_function(&reader, &s, 0) && grow_inputs(r)) {
        r->input[r->n_inputs] = s;
        r->input_name[r->n_inputs] = name;
        r->input_token[r->n_inputs++] = card->token;
    }
}
