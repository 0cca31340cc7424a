/* read_columns.c - the cards of a system file that name columns, rows and multipliers. */
#include "reader.h"
#include "reading.h"

#include <math.h>
#include <string.h>

const char *dalcs_reading_name(struct dalcs_reader *reader, const char *what) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    struct dalcs_builder *builder = reader->builder;
    if (token == NULL || (token->kind != DALCS_TOKEN_WORD && token->kind != DALCS_TOKEN_STRING)) {
        dalcs_reader_missing(reader, what);
        return NULL;
    }
    reader->at++;
    const char *name = dalcs_arena_copy(&builder->circuit->arena, token->text, strlen(token->text));
    builder->out_of_memory = builder->out_of_memory || name == NULL;
    return name;
}

void dalcs_reading_take_unit(struct dalcs_reading *r, struct dalcs_reader *reader,
                             bool *is_current) {
    if (dalcs_reader_take_word(reader, "a")) {
        *is_current = true;
        r->has_units = true;
    } else if (dalcs_reader_take_word(reader, "v")) {
        *is_current = false;
        r->has_units = true;
    }
}

static bool grow(struct dalcs_reading *r, void *array, size_t *capacity, size_t n, size_t size) {
    bool done = dalcs_grow(array, capacity, n + 1, size) == DALCS_OK;
    r->builder.out_of_memory = r->builder.out_of_memory || !done;
    return done;
}

/* ---- States, unknowns, rows ---------------------------------------------------------------- */

static bool read_kind(struct dalcs_reader *reader, enum dalcs_label_kind *kind) {
    static const char *const name[] = {[DALCS_LABEL_STATE] = "state",
                                       [DALCS_LABEL_NODE] = "node",
                                       [DALCS_LABEL_BRANCH] = "branch",
                                       [DALCS_LABEL_REFERENCE] = "reference"};
    for (size_t k = 0; k < sizeof name / sizeof name[0]; k++) {
        if (dalcs_reader_take_word(reader, name[k])) {
            *kind = (enum dalcs_label_kind)k;
            return true;
        }
    }
    dalcs_reader_missing(reader, "state, node, branch or reference");
    return false;
}

/* A column's number, which the file counts from 1. */
static bool read_number_of_column(struct dalcs_reader *reader, int *column) {
    double value;
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "the number of a column", &value)) {
        return false;
    }
    if (!(value >= 1.0 && value <= 1e9) || value != floor(value)) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "a column's number is 1, 2, 3, ...");
        return false;
    }
    *column = (int)value - 1;
    return true;
}

/* name [V|A] [value] [kind=...] [root=N] [dual=N] */
static bool read_described(struct dalcs_reading *r, struct dalcs_reader *reader, bool is_state,
                           struct dalcs_described_column *c) {
    c->name = dalcs_reading_name(reader, "a name");
    if (c->name == NULL) {
        return false;
    }
    dalcs_reading_take_unit(r, reader, &c->is_current);
    const struct dalcs_token *token;
    while ((token = dalcs_reader_peek(reader, 0)) != NULL) {
        const struct dalcs_token *parameter = dalcs_reader_take_parameter(reader);
        bool ok;
        if (parameter == NULL && is_state && !c->has_initial && dalcs_reader_is_number(token)) {
            c->has_initial = true;
            ok = dalcs_reader_number(reader, DALCS_PLAIN, "an initial value", &c->initial);
        } else if (parameter != NULL && strcmp(parameter->text, "kind") == 0) {
            ok = read_kind(reader, &c->kind);
        } else if (parameter != NULL && strcmp(parameter->text, "root") == 0) {
            ok = read_number_of_column(reader, &c->root);
        } else if (parameter != NULL && strcmp(parameter->text, "dual") == 0) {
            ok = read_number_of_column(reader, &c->dual);
        } else {
            reader->at -= parameter != NULL ? 2 : 0;
            dalcs_reader_unexpected(reader);
            ok = false;
        }
        if (!ok) {
            return false;
        }
    }
    return true;
}

static void take_described(struct dalcs_reading *r, const struct dalcs_card *card, bool is_state,
                           enum dalcs_label_kind kind, struct dalcs_described_column **array,
                           size_t *n, size_t *capacity) {
    struct dalcs_reader reader = dalcs_reader_start(
        &r->builder, card, is_state ? "state name [V|A] [initial value]" : "unknown name [V|A]");
    struct dalcs_described_column c = {.kind = kind, .root = -1, .dual = -1};
    if (read_described(r, &reader, is_state, &c) && grow(r, array, capacity, *n, sizeof **array)) {
        (*array)[(*n)++] = c;
    }
}

/* coordinate q [position] [velocity] */
static void take_coordinate(struct dalcs_reading *r, struct dalcs_described_system *s,
                            const struct dalcs_card *card) {
    struct dalcs_reader reader =
        dalcs_reader_start(&r->builder, card, "coordinate name [position] [velocity]");
    struct dalcs_described_column c = {.kind = DALCS_LABEL_STATE, .root = -1, .dual = -1};
    struct dalcs_described_column v = c;
    c.name = dalcs_reading_name(&reader, "a name");
    v.is_current = true;
    c.has_initial = !dalcs_reader_at_end(&reader);
    v.has_initial = c.has_initial;
    if (c.name == NULL ||
        (c.has_initial && !dalcs_reader_number(&reader, DALCS_PLAIN, "a position", &c.initial)) ||
        (!dalcs_reader_at_end(&reader) &&
         !dalcs_reader_number(&reader, DALCS_PLAIN, "a velocity", &v.initial)) ||
        !dalcs_reader_end(&reader)) {
        return;
    }
    v.name = dalcs_arena_printf(&r->builder.circuit->arena, "d(%s)", c.name);
    r->builder.out_of_memory = r->builder.out_of_memory || v.name == NULL;
    /* Coordinates first: the velocities are moved behind them when all are known. */
    if (grow(r, &s->state, &s->state_capacity, s->n_states + 1, sizeof *s->state)) {
        s->state[s->n_states++] = c;
        s->state[s->n_states++] = v;
        s->n_coordinates++;
    }
}

/* ---- Multipliers --------------------------------------------------------------------------- */

static bool read_bound(struct dalcs_reader *reader, const char *what, double infinity,
                       double *bound) {
    const char *const word = infinity > 0.0 ? "inf" : "-inf";
    if (dalcs_reader_take_word(reader, word)) {
        *bound = infinity;
        return true;
    }
    return dalcs_reader_list_number(reader, DALCS_PLAIN, what, bound);
}

static bool read_box(struct dalcs_reader *reader, struct dalcs_multiplier *m) {
    if (!read_bound(reader, "a lower bound", -INFINITY, &m->low) ||
        !read_bound(reader, "an upper bound", INFINITY, &m->high)) {
        return false;
    }
    if (!(m->low < m->high)) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "the upper bound must be greater than the lower one");
        return false;
    }
    bool is_free = isinf(m->low) && isinf(m->high);
    bool is_half_line = m->low == 0.0 && isinf(m->high);
    m->cone = is_free ? DALCS_CONE_FREE : is_half_line ? DALCS_CONE_HALF_LINE : DALCS_CONE_BOX;
    return true;
}

static bool read_friction(struct dalcs_reader *reader, struct dalcs_multiplier *m) {
    m->constraint = DALCS_FRICTION;
    m->cone = DALCS_CONE_BOX;
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "the greatest friction", &m->high)) {
        return false;
    }
    m->low = -m->high;
    if (!(m->high > 0.0)) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "the greatest friction must be positive");
        return false;
    }
    return true;
}

enum multiplier_card {
    PAIR,
    CORNER,
    BREAKDOWN,
    SWITCH,
    BOX,
    FREE,
    CONTACT,
    BILATERAL,
    FRICTION,
    N_CARDS
};

static bool read_multiplier(struct dalcs_reader *reader, enum multiplier_card kind,
                            struct dalcs_multiplier *m) {
    m->pair.element = dalcs_reading_name(reader, "a name");
    if (m->pair.element == NULL) {
        return false;
    }
    switch (kind) {
    case CORNER:
        m->pair.is_formula = true;
        break;
    case BREAKDOWN:
        m->pair.is_breakdown = true;
        break;
    case SWITCH:
        return dalcs_reading_switch(reader, &m->pair);
    case BOX:
        if (!read_box(reader, m)) {
            return false;
        }
        break;
    case FREE:
        m->cone = DALCS_CONE_FREE;
        break;
    case CONTACT:
        m->constraint = DALCS_CONTACT;
        break;
    case BILATERAL:
        m->constraint = DALCS_BILATERAL;
        m->cone = DALCS_CONE_FREE;
        break;
    case FRICTION:
        if (!read_friction(reader, m)) {
            return false;
        }
        break;
    default:
        break;
    }
    return dalcs_reader_end(reader);
}

static bool take_multiplier(struct dalcs_reading *r, struct dalcs_described_system *s,
                            const struct dalcs_card *card) {
    static const struct {
        const char *word, *usage;
    } cards[N_CARDS] = {
        [PAIR] = {"pair", "pair name"},
        [CORNER] = {"corner", "corner name"},
        [BREAKDOWN] = {"reverse", "reverse name"},
        [SWITCH] = {"switch", "switch name on=value off=value [valve=number] [closed] [direct]"},
        [BOX] = {"interval", "interval name low high"},
        [FREE] = {"free", "free name"},
        [CONTACT] = {"contact", "contact name"},
        [BILATERAL] = {"joint", "joint name"},
        [FRICTION] = {"friction", "friction name limit"}};

    for (int k = 0; k < N_CARDS; k++) {
        if (strcmp(card->token->text, cards[k].word) != 0) {
            continue;
        }
        struct dalcs_reader reader = dalcs_reader_start(&r->builder, card, cards[k].usage);
        struct dalcs_multiplier m = {.pair = {.kind = DALCS_PAIR_DIODE}};
        if (read_multiplier(&reader, (enum multiplier_card)k, &m) &&
            grow(r, &s->multiplier, &s->multiplier_capacity, s->n_multipliers,
                 sizeof *s->multiplier)) {
            s->multiplier[s->n_multipliers++] = m;
        }
        return true;
    }
    return false;
}

/* inputs name ... */
static void take_inputs(struct dalcs_reading *r, struct dalcs_described_system *s,
                        const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(&r->builder, card, "inputs name name ...");
    s->names_inputs = true;
    while (!dalcs_reader_at_end(&reader)) {
        const struct dalcs_token *token = dalcs_reader_peek(&reader, 0);
        const char *name = dalcs_reading_name(&reader, "the name of an input");
        int index = -1;
        for (size_t k = 0; k < r->n_inputs && name != NULL && index < 0; k++) {
            index = strcmp(r->input_name[k], name) == 0 ? (int)k : -1;
        }
        if (name == NULL) {
            return;
        }
        if (index < 0) {
            dalcs_builder_error(&r->builder, token,
                                "inputs come before the systems: input name ...",
                                "no input is called '%s'", name);
            return;
        }
        if (grow(r, &s->input, &s->input_capacity, s->n_inputs, sizeof *s->input)) {
            s->input[s->n_inputs++] = index;
        }
    }
}

bool dalcs_reading_take_column(struct dalcs_reading *r, struct dalcs_described_system *s,
                               const struct dalcs_card *card) {
    const char *word = card->token->text;
    if (strcmp(word, "state") == 0) {
        take_described(r, card, true, DALCS_LABEL_STATE, &s->state, &s->n_states,
                       &s->state_capacity);
    } else if (strcmp(word, "unknown") == 0) {
        take_described(r, card, false, DALCS_LABEL_BRANCH, &s->unknown, &s->n_unknowns,
                       &s->unknown_capacity);
    } else if (strcmp(word, "row") == 0) {
        take_described(r, card, false, DALCS_LABEL_BRANCH, &s->row, &s->n_rows, &s->row_capacity);
    } else if (strcmp(word, "inputs") == 0) {
        take_inputs(r, s, card);
    } else if (strcmp(word, "coordinate") == 0) {
        take_coordinate(r, s, card);
    } else {
        return take_multiplier(r, s, card);
    }
    return true;
}
