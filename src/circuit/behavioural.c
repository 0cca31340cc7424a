/* behavioural.c - sources with a formula: B with V= or I=, E and G with VALUE or TABLE. */
#include "behaviour.h"
#include "element_cards.h"
#include "formula_writer.h"
#include "reader.h"

#include <stdlib.h>
#include <string.h>

static const char USAGE[] =
    "a behavioural source is: Bname node node V=expression, or I=, R=, P=expression";

static struct dalcs_formula_source *add_source(struct dalcs_builder *builder,
                                               const struct dalcs_device *device) {
    if (dalcs_grow(&builder->formulas.source, &builder->formulas.capacity, builder->formulas.n + 1,
                   sizeof *builder->formulas.source) != DALCS_OK) {
        builder->out_of_memory = true;
        return NULL;
    }
    struct dalcs_formula_source *source = &builder->formulas.source[builder->formulas.n++];
    *source = (struct dalcs_formula_source){.device = (int)(device - builder->circuit->device)};
    return source;
}

/* A formula; `false` when an error was reported. */
static bool read_formula(struct dalcs_reader *reader, const struct dalcs_token **token) {
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

/* tc1=, temp= and the like behind a formula: nothing depends on a temperature. And what LTspice's steps are told there. */
static bool skip_temperature(struct dalcs_reader *reader) {
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

/* The end of such a card. */
static void add_element(struct dalcs_reader *reader, struct dalcs_device *device,
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

/* m= of ngspice and Xyce, n alike in parallel, of those that make a current. */
static bool read_parallel(struct dalcs_reader *reader, double *n) {
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
    if (!read_formula(&reader, &token) || !skip_temperature(&reader) ||
        !read_parallel(&reader, &m) || !skip_temperature(&reader)) {
        return;
    }
    (void)dalcs_reader_take_word(&reader, "noiseless");
    add_element(&reader, device, token, 'r', n * m);
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

void dalcs_behavioural_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    int node[2];
    if (!dalcs_reader_nodes(&reader, 2, node)) {
        return;
    }
    const struct dalcs_token *what = dalcs_reader_take_parameter(&reader);
    if (what == NULL) {
        dalcs_reader_missing(&reader, "V= or I=");
        return;
    }
    const char quantity = what->text[1] == '\0' ? what->text[0] : '?';
    if (strchr("virp", quantity) == NULL) {
        dalcs_builder_error(builder, what, USAGE, "a behavioural source has no '%s='", what->text);
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
    struct dalcs_parasitics across = {0};
    if (!read_formula(&reader, &token) || !skip_temperature(&reader) ||
        (quantity != 'v' && !read_parallel(&reader, &m)) || !skip_temperature(&reader) ||
        (quantity == 'i' && !read_across(&reader, &across)) || !skip_temperature(&reader)) {
        return;
    }
    const struct dalcs_token *next = dalcs_reader_peek(&reader, 0);
    if (strchr("vi", quantity) != NULL && next != NULL && strcmp(next->text, "laplace") == 0) {
        dalcs_transfer_parse_behind(&reader, device, token, m);
    } else {
        add_element(&reader, device, token, quantity, m);
    }
    dalcs_parasitic_multiply(&across, m);
    dalcs_parasitic_expand(builder, card->token, device, &across);
}

int dalcs_behavioural_parse_control(struct dalcs_reader *reader,
                                    const struct dalcs_token *element) {
    const struct dalcs_token *token;
    if (!read_formula(reader, &token)) {
        return -1;
    }
    struct dalcs_device *device =
        dalcs_builder_add_inner_device(reader->builder, DALCS_VCVS, "control", element);
    const int node = dalcs_builder_inner_node(reader->builder, "control", element);
    struct dalcs_formula_source *source =
        device != NULL ? add_source(reader->builder, device) : NULL;
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
    struct dalcs_formula_source *source = device != NULL ? add_source(builder, device) : NULL;
    if (source == NULL || node < 0) {
        return -1;
    }
    device->node[0] = node;
    source->token = formula;
    return node;
}

void dalcs_behavioural_add_formula(struct dalcs_builder *builder, const struct dalcs_device *device,
                                   const struct dalcs_token *formula) {
    struct dalcs_formula_source *source = formula != NULL ? add_source(builder, device) : NULL;
    if (source != NULL) {
        source->token = formula;
    }
}

void dalcs_behavioural_add_table(struct dalcs_builder *builder, const struct dalcs_device *device,
                                 const struct dalcs_piecewise *table) {
    struct dalcs_formula_source *source = add_source(builder, device);
    if (source != NULL) {
        source->has_table = true;
        source->table = *table;
    }
}

bool dalcs_behavioural_is_form(const struct dalcs_token *token) {
    static const char *const forms[] = {"value", "vol", "cur", "table"};
    return token != NULL && token->kind == DALCS_TOKEN_WORD &&
           dalcs_builder_is_one_of(token->text, forms, sizeof forms / sizeof forms[0]);
}

/* (x,y) (x,y) ..., with parentheses or without. */
static bool read_points(struct dalcs_reader *reader, struct dalcs_piecewise *table) {
    const size_t most = (size_t)reader->card->n;
    table->knot = dalcs_arena_alloc(&reader->builder->scratch, most, sizeof *table->knot);
    if (table->knot == NULL) {
        reader->builder->out_of_memory = true;
        return false;
    }
    do {
        double x;
        double y;
        while (dalcs_reader_take(reader, DALCS_TOKEN_OPEN)) {
        }
        if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "the x of a point", &x)) {
            return false;
        }
        const struct dalcs_token *place = dalcs_reader_previous(reader);
        if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "the y of a point", &y)) {
            return false;
        }
        while (dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        }
        if (table->n > 0 && !(x > table->knot[table->n - 1].at)) {
            dalcs_builder_error(reader->builder, place, "a jump is written with sgn() or u()",
                                "the x of a table must ascend");
            return false;
        }
        table->knot[table->n++] = (struct dalcs_knot){x, y, y, y};
    } while (!dalcs_reader_at_end(reader));
    return true;
}

bool dalcs_behavioural_has_own_table(const struct dalcs_card *card) {
    static const char *const names[] = {"tbl", "table"};
    return card->letter == 'i' && card->n > 3 && card->token[3].kind == DALCS_TOKEN_WORD &&
           dalcs_builder_is_one_of(card->token[3].text, names, sizeof names / sizeof names[0]);
}

void dalcs_behavioural_parse_own_table(struct dalcs_builder *builder,
                                       const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(
        builder, card, "such a source is: Iname node node TBL=(v1,i1, v2,i2, ...)");
    struct dalcs_device *device = dalcs_builder_add_device(builder, DALCS_VCCS, card->token);
    struct dalcs_piecewise table = {0};
    if (device == NULL || !dalcs_reader_nodes(&reader, 2, device->node)) {
        return;
    }
    device->node[2] = device->node[0];
    device->node[3] = device->node[1];
    reader.at++;
    dalcs_reader_take(&reader, DALCS_TOKEN_EQUAL);
    if (!read_points(&reader, &table)) {
        return;
    }
    for (int k = 0; k < table.n; k++) {
        const double i = table.knot[k].value * dalcs_parallel_of(card);
        table.knot[k].left = table.knot[k].value = table.knot[k].right = i;
    }
    dalcs_behavioural_add_table(builder, device, &table);
}

void dalcs_behavioural_parse_form(struct dalcs_reader *reader, struct dalcs_device *device) {
    const struct dalcs_token *form = dalcs_reader_peek(reader, 0);
    const bool is_table = strcmp(form->text, "table") == 0;
    const struct dalcs_token *next;
    struct dalcs_piecewise table = {0};
    const struct dalcs_token *token = NULL;
    reader->usage = is_table ? "a table is: TABLE {expression} = (x1,y1) (x2,y2) ..."
                             : "such a source is: VALUE={expression}";
    reader->at++;
    dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    next = dalcs_reader_peek(reader, 0);
    const bool has_formula = next == NULL || next->kind == DALCS_TOKEN_FORMULA ||
                             next->kind == DALCS_TOKEN_BAD || !is_table;
    if (has_formula && !read_formula(reader, &token)) {
        return;
    }
    if (is_table && has_formula) {
        dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    }
    if (!is_table) {
        double m = 1;
        if (skip_temperature(reader) && (device->kind == DALCS_VCVS || read_parallel(reader, &m))) {
            add_element(reader, device, token, device->kind == DALCS_VCVS ? 'v' : 'i', m);
        }
        return;
    }
    if (!read_points(reader, &table)) {
        return;
    }
    struct dalcs_formula_source *source = add_source(reader->builder, device);
    if (source != NULL) {
        source->token = token;
        source->has_table = true;
        source->table = table;
    }
}
