/* read_outputs.c - what of a system is recorded: `output` and `element` cards, or everything.
 *
 *     output NAME [V|A] [in SYSTEM] column value column value ... [minus [in SYSTEM] column value ...]
 *
 * A column is a name, #N (its number), @N (an input's) or w(NAME). */
#include "reader.h"
#include "reading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct terms {
    int n_columns, n_inputs;
    size_t column_capacity, input_capacity;
    struct dalcs_probe_term *column, *input; /* heap */
};

static void terms_finish(struct terms *t) {
    free(t->column);
    free(t->input);
}

static enum dalcs_status add_column(struct terms *t, int column, double value) {
    DALCS_TRY(
        dalcs_grow(&t->column, &t->column_capacity, (size_t)t->n_columns + 1, sizeof *t->column));
    t->column[t->n_columns++] = (struct dalcs_probe_term){column, value};
    return DALCS_OK;
}

static enum dalcs_status add_input(struct terms *t, int input, double value) {
    DALCS_TRY(dalcs_grow(&t->input, &t->input_capacity, (size_t)t->n_inputs + 1, sizeof *t->input));
    t->input[t->n_inputs++] = (struct dalcs_probe_term){input, value};
    return DALCS_OK;
}

/* factor times w of a pair */
static enum dalcs_status add_w(struct terms *t, const struct dalcs_system *s, int pair,
                               double factor) {
    for (int k = s->C.p[pair]; k < s->C.p[pair + 1]; k++) {
        DALCS_TRY(add_column(t, s->C.j[k], factor * s->C.x[k]));
    }
    for (int k = s->F.p[pair]; k < s->F.p[pair + 1]; k++) {
        DALCS_TRY(add_input(t, s->F.j[k], factor * s->F.x[k]));
    }
    return DALCS_OK;
}

static enum dalcs_status keep(struct dalcs_reading *r, struct dalcs_probe *probe, int system,
                              const struct terms *t) {
    int n = t->n_columns + t->n_inputs;
    *probe = (struct dalcs_probe){
        .system = n > 0 ? system : -1, .n_terms = t->n_columns, .n_inputs = t->n_inputs};
    if (n == 0) {
        return DALCS_OK;
    }
    probe->term = dalcs_arena_alloc(&r->network->arena, (size_t)n, sizeof *probe->term);
    if (probe->term == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < t->n_columns; k++) {
        probe->term[k] = t->column[k];
    }
    for (int k = 0; k < t->n_inputs; k++) {
        probe->term[t->n_columns + k] = t->input[k];
    }
    return DALCS_OK;
}

/* ---- Multipliers by their names in the file ----------------------------------------------------- */

/* lambda of multiplier j: as cones.c placed it. */
struct place {
    int pair, bound; /* -1: an unknown; no box of two bounds */
    int column;
    double sign, offset;
};

static struct place place_of(const struct dalcs_described_system *d, const struct dalcs_system *s,
                             size_t j) {
    struct place p = {.pair = -1, .bound = -1, .sign = 1.0};
    int next_z = s->n_x + (int)d->n_unknowns;
    int next_pair = 0;
    for (size_t k = 0; k <= j; k++) {
        const struct dalcs_multiplier *m = &d->multiplier[k];
        bool is_unknown = dalcs_multiplier_is_unknown(m);
        bool is_box = m->cone == DALCS_CONE_BOX;
        p.pair = is_unknown ? -1 : next_pair;
        p.column = is_unknown ? next_z : dalcs_system_n_equations(s) + next_pair;
        p.bound = is_unknown && is_box ? next_pair : -1;
        p.sign = is_box && !is_unknown && !isfinite(m->low) ? -1.0 : 1.0;
        p.offset = !is_box || is_unknown ? 0.0 : isfinite(m->low) ? m->low : m->high;
        next_z += is_unknown ? 1 : 0;
        next_pair += !is_unknown ? 1 : is_box ? 2 : 0;
    }
    return p;
}

static enum dalcs_status add_lambda(struct terms *t, const struct place *p, double factor) {
    DALCS_TRY(add_column(t, p->column, factor * p->sign));
    return p->offset != 0.0 ? add_input(t, 0, factor * p->offset) : DALCS_OK;
}

/* w = sign times w of the pair; of a box, up minus down; of a free one 0 */
static enum dalcs_status add_w_of(struct terms *t, const struct dalcs_system *s,
                                  const struct place *p, double factor) {
    if (p->bound >= 0) {
        int up = dalcs_system_n_equations(s) + p->bound;
        DALCS_TRY(add_column(t, up, factor));
        return add_column(t, up + 1, -factor);
    }
    return p->pair < 0 ? DALCS_OK : add_w(t, s, p->pair, factor * p->sign);
}

/* ---- Cards --------------------------------------------------------------------------------- */

/* The number behind # or @, from 1; -1 when it is none up to `most`. */
static int number_of(const char *text, int most) {
    long value = strtol(text, NULL, 10);
    bool valid = *text != '\0' && text[strspn(text, "0123456789")] == '\0' && strlen(text) < 10;
    return valid && value >= 1 && value <= most ? (int)value : -1;
}

/* Adds factor times what a name stands for; false when there is no such thing. */
static bool add_named(struct dalcs_reading *r, struct terms *t, int system, const char *name,
                      double factor) {
    const struct dalcs_system *s = &r->network->system[system];
    const struct dalcs_described_system *d = &r->system[system];
    enum dalcs_status status = DALCS_OK;
    bool found = true;
    if (name[0] == '#') {
        int n_equations = (int)(d->n_states + d->n_unknowns);
        int column = number_of(name + 1, n_equations + (int)d->n_multipliers);
        found = column > 0;
        if (found && column > n_equations) {
            const struct place p = place_of(d, s, (size_t)(column - n_equations - 1));
            status = add_lambda(t, &p, factor);
        } else if (found) {
            status = add_column(t, column - 1, factor);
        }
    } else if (name[0] == '@') {
        int input = strcmp(name, "@0") == 0 ? 0 : number_of(name + 1, s->n_inputs - 1);
        found = input >= 0; /* @0 is the constant 1 */
        status = found ? add_input(t, input, factor) : DALCS_OK;
    } else {
        found = false;
        for (size_t c = 0; c < d->n_states + d->n_unknowns && !found; c++) {
            found = strcmp(s->column[c].element, name) == 0;
            status = found ? add_column(t, (int)c, factor) : DALCS_OK;
        }
        for (size_t j = 0; j < d->n_multipliers && !found; j++) {
            found = strcmp(d->multiplier[j].pair.element, name) == 0;
            const struct place p = place_of(d, s, j);
            status = found ? add_lambda(t, &p, factor) : DALCS_OK;
        }
        for (int k = 1; k < s->n_inputs && !found; k++) {
            found = strcmp(s->input_element[k], name) == 0;
            status = found ? add_input(t, k, factor) : DALCS_OK;
        }
    }
    r->builder.out_of_memory = r->builder.out_of_memory || status != DALCS_OK;
    return found;
}

static bool add_w_named(struct dalcs_reading *r, struct terms *t, int system, const char *name,
                        double factor) {
    const struct dalcs_described_system *d = &r->system[system];
    for (size_t j = 0; j < d->n_multipliers; j++) {
        if (strcmp(d->multiplier[j].pair.element, name) == 0) {
            const struct dalcs_system *s = &r->network->system[system];
            const struct place p = place_of(d, s, j);
            r->builder.out_of_memory =
                r->builder.out_of_memory || add_w_of(t, s, &p, factor) != DALCS_OK;
            return true;
        }
    }
    return false;
}

/* [in SYSTEM] column value column value ... up to `minus` or the end. */
static bool read_terms(struct dalcs_reading *r, struct dalcs_reader *reader,
                       struct dalcs_probe *probe) {
    struct terms t = {0};
    int system = 0;
    bool ok = true;
    if (dalcs_reader_take_word(reader, "in")) {
        double value;
        ok = dalcs_reader_number(reader, DALCS_PLAIN, "the number of a system", &value);
        system = ok && value >= 1.0 && value <= (double)r->n_systems ? (int)value - 1 : -1;
    }
    if (ok && (system < 0 || r->n_systems == 0)) {
        dalcs_builder_error(&r->builder, dalcs_reader_previous(reader), NULL,
                            "outputs come after the systems, which count from 1");
        ok = false;
    }
    const struct dalcs_token *token;
    while (ok && (token = dalcs_reader_peek(reader, 0)) != NULL &&
           strcmp(token->text, "minus") != 0) {
        const struct dalcs_token *next = dalcs_reader_peek(reader, 1);
        bool is_w = next != NULL && next->kind == DALCS_TOKEN_OPEN &&
                    dalcs_reader_take_word(reader, "w") &&
                    dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
        token = dalcs_reader_peek(reader, 0);
        const char *name = dalcs_reading_name(reader, "a column");
        double factor = 1.0;
        ok = name != NULL && (!is_w || dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) &&
             dalcs_reader_number(reader, DALCS_PLAIN, "a factor", &factor);
        if (ok && !(is_w ? add_w_named(r, &t, system, name, factor)
                         : add_named(r, &t, system, name, factor))) {
            dalcs_builder_error(&r->builder, token, NULL, "the system has no '%s'", name);
            ok = false;
        }
    }
    if (ok) {
        r->builder.out_of_memory =
            r->builder.out_of_memory || keep(r, probe, system, &t) != DALCS_OK;
    }
    terms_finish(&t);
    return ok && !r->builder.out_of_memory;
}

static enum dalcs_status add_output(struct dalcs_reading *r, const struct dalcs_output *out) {
    DALCS_TRY(dalcs_grow(&r->output, &r->output_capacity, r->n_outputs + 1, sizeof *r->output));
    r->output[r->n_outputs++] = *out;
    return DALCS_OK;
}

static enum dalcs_status add_element(struct dalcs_reading *r, const struct dalcs_state *state) {
    DALCS_TRY(dalcs_grow(&r->element, &r->element_capacity, r->n_elements + 1, sizeof *r->element));
    r->element[r->n_elements++] = *state;
    return DALCS_OK;
}

void dalcs_reading_take_output(struct dalcs_reading *r, const struct dalcs_card *card) {
    bool is_output = strcmp(card->token->text, "output") == 0;
    struct dalcs_reader reader = dalcs_reader_start(
        &r->builder, card, "output name [V|A] column factor column factor ... [minus ...]");
    struct dalcs_output out = {.plus = {.system = -1}, .minus = {.system = -1}};
    out.name = dalcs_reading_name(&reader, "a name");
    if (out.name == NULL) {
        return;
    }
    dalcs_reading_take_unit(r, &reader, &out.is_current);
    if (!read_terms(r, &reader, &out.plus) ||
        (is_output && dalcs_reader_take_word(&reader, "minus") &&
         !read_terms(r, &reader, &out.minus)) ||
        !dalcs_reader_end(&reader)) {
        return;
    }
    const struct dalcs_state state = {out.name, out.is_current, out.plus};
    enum dalcs_status status = is_output ? add_output(r, &out) : add_element(r, &state);
    r->builder.out_of_memory = r->builder.out_of_memory || status != DALCS_OK;
}

/* ---- Everything ---------------------------------------------------------------------------- */

static enum dalcs_status add_everything(struct dalcs_reading *r, int system) {
    struct dalcs_arena *arena = &r->network->arena;
    const struct dalcs_system *s = &r->network->system[system];
    const struct dalcs_described_system *d = &r->system[system];
    for (int c = 0; c < s->n_x + (int)d->n_unknowns; c++) {
        struct terms t = {0};
        struct dalcs_output out = {.name = s->column[c].element,
                                   .is_current = s->column_is_current[c],
                                   .minus = {.system = -1}};
        enum dalcs_status status = add_column(&t, c, 1.0);
        status = status == DALCS_OK ? keep(r, &out.plus, system, &t) : status;
        terms_finish(&t);
        DALCS_TRY(status);
        DALCS_TRY(add_output(r, &out));
    }
    for (size_t j = 0; j < d->n_multipliers; j++) {
        const struct place p = place_of(d, s, j);
        for (int is_w = 0; is_w < (p.pair < 0 && p.bound < 0 ? 1 : 2); is_w++) {
            struct terms t = {0};
            struct dalcs_output out = {.name =
                                           dalcs_arena_printf(arena, is_w ? "w(%s)" : "lambda(%s)",
                                                              d->multiplier[j].pair.element),
                                       .is_current = !is_w,
                                       .minus = {.system = -1}};
            enum dalcs_status status = is_w ? add_w_of(&t, s, &p, 1.0) : add_lambda(&t, &p, 1.0);
            status = status == DALCS_OK ? keep(r, &out.plus, system, &t) : status;
            terms_finish(&t);
            DALCS_TRY(status);
            DALCS_TRY(out.name == NULL ? DALCS_E_NOMEM : add_output(r, &out));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status add_states(struct dalcs_reading *r, int system) {
    const struct dalcs_system *s = &r->network->system[system];
    for (int x = 0; x < s->n_x; x++) {
        struct terms t = {0};
        struct dalcs_state state = {s->column[x].element, s->column_is_current[x], {0}};
        enum dalcs_status status = add_column(&t, x, 1.0);
        status = status == DALCS_OK ? keep(r, &state.probe, system, &t) : status;
        terms_finish(&t);
        DALCS_TRY(status);
        DALCS_TRY(add_element(r, &state));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_reading_default_outputs(struct dalcs_reading *r) {
    bool has_outputs = r->n_outputs > 0;
    bool has_elements = r->n_elements > 0;
    for (int k = 0; k < (int)r->n_systems; k++) {
        if (!has_outputs) {
            DALCS_TRY(add_everything(r, k));
        }
        if (!has_elements) {
            DALCS_TRY(add_states(r, k));
        }
    }
    return DALCS_OK;
}
