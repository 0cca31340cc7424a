/* behavioural_forms.c - sources of other kinds with a formula or a table: E and G with VALUE or TABLE, I with TBL. */
#include "behavioural.h"

#include <string.h>

void dalcs_behavioural_add_formula(struct dalcs_builder *builder, const struct dalcs_device *device,
                                   const struct dalcs_token *formula) {
    struct dalcs_formula_source *source =
        formula != NULL ? dalcs_behavioural_add_source(builder, device) : NULL;
    if (source != NULL) {
        source->token = formula;
    }
}

void dalcs_behavioural_add_table(struct dalcs_builder *builder, const struct dalcs_device *device,
                                 const struct dalcs_piecewise *table) {
    struct dalcs_formula_source *source = dalcs_behavioural_add_source(builder, device);
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
    if (has_formula && !dalcs_behavioural_read_formula(reader, &token)) {
        return;
    }
    if (is_table && has_formula) {
        dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    }
    if (!is_table) {
        double m = 1;
        if (dalcs_behavioural_skip_temperature(reader) &&
            (device->kind == DALCS_VCVS || dalcs_behavioural_read_parallel(reader, &m))) {
            dalcs_behavioural_add_element(reader, device, token,
                                          device->kind == DALCS_VCVS ? 'v' : 'i', m);
        }
        return;
    }
    if (!read_points(reader, &table)) {
        return;
    }
    struct dalcs_formula_source *source = dalcs_behavioural_add_source(reader->builder, device);
    if (source != NULL) {
        source->token = token;
        source->has_table = true;
        source->table = table;
    }
}
