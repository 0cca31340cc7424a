/* behavioural.c - sources and resistors with a formula: B with V=, I=, R= or P=. */
#include "behavioural.h"

#include "formula_writer.h"

#include <string.h>

static const char USAGE[] =
    "a behavioural source is: Bname node node V=expression, or I=, R=, P=expression";

struct dalcs_formula_source *dalcs_behavioural_add_source(struct dalcs_builder *builder,
                                                          const struct dalcs_device *device) {
    if (dalcs_grow(&builder->formulas.source, &builder->formulas.capacity, builder->formulas.n + 1,
                   sizeof *builder->formulas.source) != DALCS_OK) {
        builder->out_of_memory = true;
        return NULL;
    }
    const int index = (int)(device - builder->circuit->device);
    struct dalcs_formula_source *source = &builder->formulas.source[builder->formulas.n++];
    for (; source > builder->formulas.source && source[-1].device > index; source--) {
        *source = source[-1]; /* one of a card that was read before */
    }
    *source = (struct dalcs_formula_source){.device = index};
    return source;
}

bool dalcs_behavioural_read_formula(struct dalcs_reader *reader, const struct dalcs_token **token) {
    *token = dalcs_reader_peek(reader, 0);
    if (*token == NULL) {
        dalcs_reader_missing(reader, "an expression");
        return false;
    }
    if ((*token)->kind == DALCS_TOKEN_BAD) {
        reader->builder->failed = true;
        return false;
    }
    if ((*token)->kind != DALCS_TOKEN_FORMULA) {
        dalcs_reader_unexpected(reader);
        return false;
    }
    reader->at++;
    return true;
}

bool dalcs_behavioural_skip_temperature(struct dalcs_reader *reader) {
    static const char *const names[] = {"tc",         "tc1",    "tc2",    "temp", "dtemp",
                                        "reciproctc", "tripdv", "tripdt", "ic"};
    const struct dalcs_token *name;
    while ((name = dalcs_reader_peek(reader, 0)) != NULL) {
        if (dalcs_reader_take_word(reader, "nojacob")) { /* LTspice's: no derivatives */
            dalcs_builder_note(reader->builder, name, NULL,
                               "'%s' has no meaning here and is ignored", name->text);
            continue;
        }
        if (!dalcs_builder_is_one_of(name->text, names, sizeof names / sizeof names[0]) ||
            dalcs_reader_take_parameter(reader) == NULL) {
            break;
        }
        if (strcmp(name->text, "ic") == 0) {
            dalcs_builder_warn(
                reader->builder, name, NULL,
                "'ic' is left out: the formula says what the source is at the start");
        } else {
            dalcs_builder_note(reader->builder, name, NULL,
                               "'%s' has no meaning here and is ignored", name->text);
        }
        do {
            if (!dalcs_reader_skip_value(reader)) {
                return false;
            }
            name = dalcs_reader_peek(reader, 0);
        } while (name != NULL && dalcs_reader_is_number(name));
    }
    return true;
}

/* Is it 0 or 1, or steps otherwise? */
static bool is_stepped(const struct dalcs_formula *f) {
    static const char *const steps[] = {"u",   "stp",   "buf",  "inv",  "sgn",
                                        "int", "floor", "ceil", "nint", "round"};
    return (f->kind == DALCS_FORMULA_OPERATION && f->code >= DALCS_EQUAL &&
            f->code <= DALCS_GREATER_EQUAL) ||
           (f->kind == DALCS_FORMULA_OPERATION &&
            (f->code == DALCS_NOT || f->code == DALCS_TO_LOGIC || f->code == DALCS_JUMP_AND ||
             f->code == DALCS_JUMP_OR)) ||
           (f->kind == DALCS_FORMULA_CALL &&
            dalcs_builder_is_one_of(f->function, steps, sizeof steps / sizeof steps[0]));
}

/* Which nodes of the element's two a formula follows, as bits; not those that only choose between parts of it. */
static int nodes_followed(const struct dalcs_card *card, const struct dalcs_formula *f) {
    int nodes = 0;
    for (int k = 0; k < 4 && f->kind == DALCS_FORMULA_VOLTAGE; k++) {
        const struct dalcs_token *signal = f->signal[k / 2];
        const int node = k % 2;
        if (signal != NULL && strcmp(signal->text, card->token[1 + node].text) == 0) {
            nodes |= 1 << node;
        }
    }
    for (int k = f->kind == DALCS_FORMULA_CHOICE ? 1 : 0; k < f->n && !is_stepped(f); k++) {
        nodes |= nodes_followed(card, f->argument[k]);
    }
    return nodes;
}

/* A resistance R(v) by its own voltage is a current v / R(v): of v = R(v) i also v = 0 is a root where R(0) = 0, with any
 * current, and a state could jump there. */
static bool is_by_own_voltage(const struct dalcs_card *card, const struct dalcs_device *device,
                              const struct dalcs_formula *f) {
    int nodes = nodes_followed(card, f);
    const bool follows = nodes != 0;
    for (int node = 0; node < 2; node++) {
        nodes |= device->node[node] == 0 ? 1 << node : 0;
    }
    return follows && nodes == 3;
}

/* The voltage or current of an element whose card has a formula of its voltage, current, resistance or power, n alike
 * in parallel. */
static const struct dalcs_token *of_element(struct dalcs_builder *builder,
                                            const struct dalcs_card *card,
                                            const struct dalcs_token *token, char quantity,
                                            bool makes_current, double n) {
    const struct dalcs_formula *f = token->formula;
    struct dalcs_formula_writer w = {builder, token, f->text, f->number_of + 1};
    if (quantity == 'r' && makes_current) {
        f = dalcs_formula_operation(
            &w, DALCS_DIVIDE,
            dalcs_formula_signal(&w, DALCS_FORMULA_VOLTAGE, &card->token[1], &card->token[2]), f);
    } else if (quantity == 'r') {
        f = dalcs_formula_operation(
            &w, DALCS_MULTIPLY, dalcs_formula_signal(&w, DALCS_FORMULA_CURRENT, card->token, NULL),
            f);
    } else if (quantity == 'p') {
        f = dalcs_formula_operation(
            &w, DALCS_DIVIDE, f,
            dalcs_formula_signal(&w, DALCS_FORMULA_VOLTAGE, &card->token[1], &card->token[2]));
    }
    const double factor = quantity == 'r' && !makes_current ? 1 / n : n;
    if (n != 1) {
        f = dalcs_formula_operation(&w, DALCS_MULTIPLY, dalcs_formula_number(&w, factor), f);
    }
    return dalcs_formula_token(&w, f);
}

void dalcs_behavioural_add_element(struct dalcs_reader *reader, struct dalcs_device *device,
                                   const struct dalcs_token *token, char quantity, double n) {
    if (dalcs_reader_end(reader)) {
        const bool makes_current =
            quantity == 'r' && is_by_own_voltage(reader->card, device, token->formula);
        device->kind = makes_current ? DALCS_VCCS : device->kind;
        dalcs_behavioural_add_formula(
            reader->builder, device,
            of_element(reader->builder, reader->card, token, quantity, makes_current, n));
    }
}

bool dalcs_behavioural_read_parallel(struct dalcs_reader *reader, double *n) {
    const struct dalcs_token *name = dalcs_reader_peek(reader, 0);
    if (name == NULL || strcmp(name->text, "m") != 0 ||
        dalcs_reader_take_parameter(reader) == NULL) {
        return true;
    }
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "a number", n)) {
        return false;
    }
    if (!(*n > 0)) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "a multiplier must be positive");
    }
    return *n > 0;
}

bool dalcs_behavioural_is_resistance(const struct dalcs_card *card) {
    const bool has_name = card->n > 5 && card->token[4].kind == DALCS_TOKEN_EQUAL;
    return card->n > 3 && card->token[has_name ? 5 : 3].kind == DALCS_TOKEN_FORMULA;
}

void dalcs_behavioural_parse_resistance(struct dalcs_builder *builder,
                                        const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card,
                                                    "a resistor is: Rname node node "
                                                    "ohms, or R={expression}");
    struct dalcs_device *device = dalcs_builder_add_device(builder, DALCS_VCVS, card->token);
    const struct dalcs_token *token;
    double n = card->parallel > 0 ? card->parallel : 1;
    double m = 1;
    if (device == NULL || !dalcs_reader_nodes(&reader, 2, device->node)) {
        return;
    }
    (void)dalcs_reader_take_parameter(&reader);
    if (!dalcs_behavioural_read_formula(&reader, &token) ||
        !dalcs_behavioural_skip_temperature(&reader) ||
        !dalcs_behavioural_read_parallel(&reader, &m) ||
        !dalcs_behavioural_skip_temperature(&reader)) {
        return;
    }
    (void)dalcs_reader_take_word(&reader, "noiseless");
    dalcs_behavioural_add_element(&reader, device, token, 'r', n * m);
}

/* Rpar= and Cpar= of LTspice, across a source of a current. */
static bool read_across(struct dalcs_reader *reader, struct dalcs_parasitics *across) {
    const struct dalcs_token *name;
    while ((name = dalcs_reader_peek(reader, 0)) != NULL &&
           (strcmp(name->text, "rpar") == 0 || strcmp(name->text, "cpar") == 0) &&
           dalcs_reader_take_parameter(reader) != NULL) {
        if (!dalcs_parasitic_read(reader, name, across)) {
            return false;
        }
    }
    return true;
}

/* V=, I=, R= or P=: its letter, 0 after an error. What lies across a source of a current may stand before it, as LTspice
 * has it. */
static char take_quantity(struct dalcs_reader *reader, struct dalcs_parasitics *across) {
    const struct dalcs_token *first = dalcs_reader_peek(reader, 0);
    const int before = reader->at;
    if (!read_across(reader, across)) {
        return 0;
    }
    const bool has_across = reader->at > before;
    const struct dalcs_token *what = dalcs_reader_take_parameter(reader);
    if (what == NULL) {
        dalcs_reader_missing(reader, "V= or I=");
        return 0;
    }
    const bool is_known = what->text[1] == '\0' && strchr("virp", what->text[0]) != NULL;
    if (!is_known || (what->text[0] != 'i' && has_across)) {
        const struct dalcs_token *wrong = is_known ? first : what;
        dalcs_builder_error(reader->builder, wrong, USAGE, "a behavioural source has no '%s='",
                            wrong->text);
        return 0;
    }
    return what->text[0];
}

void dalcs_behavioural_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    int node[2];
    if (!dalcs_reader_nodes(&reader, 2, node)) {
        return;
    }
    struct dalcs_parasitics across = {0};
    const char quantity = take_quantity(&reader, &across);
    if (quantity == 0) {
        return;
    }
    const bool makes_voltage = quantity == 'v' || quantity == 'r';
    struct dalcs_device *device =
        dalcs_builder_add_device(builder, makes_voltage ? DALCS_VCVS : DALCS_VCCS, card->token);
    const struct dalcs_token *token;
    double m = 1;
    if (device == NULL) {
        return;
    }
    device->node[0] = node[0];
    device->node[1] = node[1];
    if (!dalcs_behavioural_read_formula(&reader, &token) ||
        !dalcs_behavioural_skip_temperature(&reader) ||
        (quantity != 'v' && !dalcs_behavioural_read_parallel(&reader, &m)) ||
        !dalcs_behavioural_skip_temperature(&reader) ||
        (quantity == 'i' && !read_across(&reader, &across)) ||
        !dalcs_behavioural_skip_temperature(&reader)) {
        return;
    }
    const struct dalcs_token *next = dalcs_reader_peek(&reader, 0);
    if (strchr("vi", quantity) != NULL && next != NULL && strcmp(next->text, "laplace") == 0) {
        dalcs_transfer_parse_behind(&reader, device, token, m);
    } else {
        dalcs_behavioural_add_element(&reader, device, token, quantity, m);
    }
    dalcs_parasitic_multiply(&across, m);
    dalcs_parasitic_expand(builder, card->token, device, &across);
}

int dalcs_behavioural_parse_control(struct dalcs_reader *reader,
                                    const struct dalcs_token *element) {
    const struct dalcs_token *token;
    if (!dalcs_behavioural_read_formula(reader, &token)) {
        return -1;
    }
    struct dalcs_device *device =
        dalcs_builder_add_inner_device(reader->builder, DALCS_VCVS, "control", element);
    const int node = dalcs_builder_inner_node(reader->builder, "control", element);
    struct dalcs_formula_source *source =
        device != NULL ? dalcs_behavioural_add_source(reader->builder, device) : NULL;
    if (source == NULL || node < 0) {
        return -1;
    }
    device->node[0] = node;
    source->token = token;
    return node;
}

int dalcs_behavioural_add_readout(struct dalcs_builder *builder, const struct dalcs_token *formula,
                                  const char *what, const struct dalcs_token *name) {
    struct dalcs_device *device = dalcs_builder_add_inner_device(builder, DALCS_VCVS, what, name);
    const int node = dalcs_builder_inner_node(builder, what, name);
    struct dalcs_formula_source *source =
        device != NULL ? dalcs_behavioural_add_source(builder, device) : NULL;
    if (source == NULL || node < 0) {
        return -1;
    }
    device->node[0] = node;
    source->token = formula;
    return node;
}
