/* block.c - .model cards of XSPICE's code models, and which of them there are. */
#include "block.h"

#include "number.h"
#include "reader.h"

#include <string.h>

static const struct {
    const char *type, *because, *hint; /* why it is refused; NULL: it is there */
} TYPES[] = {
    {"d_and", NULL, NULL},
    {"d_nand", NULL, NULL},
    {"d_or", NULL, NULL},
    {"d_nor", NULL, NULL},
    {"d_xor", NULL, NULL},
    {"d_xnor", NULL, NULL},
    {"d_buffer", NULL, NULL},
    {"d_inverter", NULL, NULL},
    {"d_dff", NULL, NULL},
    {"d_jkff", NULL, NULL},
    {"d_tff", NULL, NULL},
    {"d_srff", NULL, NULL},
    {"d_fdiv", NULL, NULL},
    {"d_pullup", NULL, NULL},
    {"d_pulldown", NULL, NULL},
    {"adc_bridge", NULL, NULL},
    {"dac_bridge", NULL, NULL},
    {"gain", NULL, NULL},
    {"summer", NULL, NULL},
    {"limit", NULL, NULL},
    {"int", NULL, NULL},
    {"slew", NULL, NULL},
    {"pwl", NULL, NULL},
    {"aswitch", NULL, NULL},
    {"pswitch", NULL, NULL},
    {"transformer", NULL, NULL},
    {"d_dt", NULL, NULL},
    {"mult", NULL, NULL},
    {"divide", NULL, NULL},
    {"climit", NULL, NULL},
    {"ilimit", "it is a limited source", "V with Ilimit=, or E and ideal diodes"},
    {"hyst", NULL, NULL},
    {"sine", NULL, NULL},
    {"triangle", NULL, NULL},
    {"square", NULL, NULL},
    {"oneshot", NULL, NULL},
    {"s_xfer", NULL, NULL},
    {"d_dlatch", NULL, NULL},
    {"d_srlatch", NULL, NULL},
    {"d_tristate", "an output in high impedance has no logic value",
     "write aswitch behind a dac_bridge"},
    {"d_open_c", "an output in high impedance has no logic value",
     "write aswitch behind a dac_bridge"},
    {"d_open_e", "an output in high impedance has no logic value",
     "write aswitch behind a dac_bridge"},
    {"d_osc", NULL, NULL},
    {"d_source", "its file is not read", "V with PWL, and an adc_bridge"},
    {"d_ram", "it has a memory of words", "a table of d_dff"},
    {"d_state", "its file is not read", "d_dff and gates"},
    {"d_lut", "its table is not read", "gates"},
    {"core", "its ports are fields", "L with Flux=pwl(x, ...), across a winding of a transformer"},
    {"lcouple", "its ports are fields", "K between coils, or a transformer"},
    {"cmeter", "it measures at a node", ".meas"},
    {"lmeter", "it measures at a node", ".meas"},
};

static int find_type(const char *type) {
    const int n = (int)(sizeof TYPES / sizeof TYPES[0]);
    int k = 0;
    while (k < n && strcmp(type, TYPES[k].type) != 0) {
        k++;
    }
    return k < n ? k : -1;
}

bool dalcs_block_is_type(const char *type) {
    return find_type(type) >= 0;
}

bool dalcs_block_is_refused(struct dalcs_builder *builder, const struct dalcs_card *card,
                            const struct dalcs_block *block) {
    const int type = find_type(block->type->text);
    if (TYPES[type].because != NULL) {
        dalcs_builder_error(builder, card->token, TYPES[type].hint, "%s is not supported: %s",
                            TYPES[type].type, TYPES[type].because);
    }
    return TYPES[type].because != NULL;
}

/* A number, true, false, or a list of such that brackets enclose; `bracket` is how many are open. */
static bool read_number(struct dalcs_reader *reader, int *bracket, double *value, bool *is_one) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    if (token == NULL || (token->kind != DALCS_TOKEN_WORD && token->kind != DALCS_TOKEN_NUMBER)) {
        dalcs_reader_missing(reader, "a value");
        return false;
    }
    reader->at++;
    *is_one = true;
    if (token->kind == DALCS_TOKEN_NUMBER) {
        *value = token->value;
        return true;
    }
    const char *begin = token->text + strspn(token->text, "[");
    *bracket += (int)(begin - token->text);
    const size_t n = strcspn(begin, "]");
    *bracket -= (int)strlen(begin + n);
    const char *text = dalcs_builder_hint(reader->builder, "%.*s", (int)n, begin);
    struct dalcs_number number;
    if (text == NULL) {
        return false;
    }
    *is_one = n > 0;
    if (n == 0) {
        return true;
    }
    if (strcmp(text, "true") == 0 || strcmp(text, "false") == 0) {
        *value = text[0] == 't';
        return true;
    }
    if (dalcs_number_parse(text, &number) != DALCS_NUMBER_OK) {
        dalcs_builder_error(reader->builder, token, NULL, "'%s' is not a number", text);
        return false;
    }
    *value = number.value;
    return true;
}

static bool read_value(struct dalcs_reader *reader, struct dalcs_block_value *value) {
    double *number =
        dalcs_arena_alloc(&reader->builder->scratch, (size_t)reader->card->n, sizeof *number);
    int bracket = 0;
    if (number == NULL) {
        reader->builder->out_of_memory = true;
        return false;
    }
    value->number = number;
    do {
        bool is_one;
        if (!read_number(reader, &bracket, &number[value->n], &is_one)) {
            return false;
        }
        value->n += is_one;
    } while (bracket > 0);
    return true;
}

const struct dalcs_block *dalcs_block_parse_model(struct dalcs_reader *reader,
                                                  const struct dalcs_token *name,
                                                  const struct dalcs_token *type) {
    struct dalcs_arena *scratch = &reader->builder->scratch;
    struct dalcs_block *block = dalcs_arena_alloc(scratch, 1, sizeof *block);
    struct dalcs_block_value *value =
        dalcs_arena_alloc(scratch, (size_t)reader->card->n, sizeof *value);
    if (block == NULL || value == NULL) {
        reader->builder->out_of_memory = true;
        return NULL;
    }
    *block = (struct dalcs_block){.name = name, .type = type, .value = value};
    const struct dalcs_token *next;
    while ((next = dalcs_reader_peek(reader, 0)) != NULL && next->kind == DALCS_TOKEN_WORD) {
        value[block->n].name = next;
        reader->at++;
        (void)dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
        if (!read_value(reader, &value[block->n])) {
            return NULL;
        }
        block->n++;
    }
    return block;
}

const struct dalcs_block_value *dalcs_block_find(const struct dalcs_block *block,
                                                 const char *name) {
    const struct dalcs_block_value *found = NULL;
    for (int k = 0; k < block->n; k++) {
        found = strcmp(block->value[k].name->text, name) == 0 ? &block->value[k] : found;
    }
    return found;
}

double dalcs_block_element(const struct dalcs_block *block, const char *name, int k,
                           double otherwise) {
    const struct dalcs_block_value *value = dalcs_block_find(block, name);
    return value != NULL && k < value->n ? value->number[k] : otherwise;
}

double dalcs_block_number(const struct dalcs_block *block, const char *name, double otherwise) {
    return dalcs_block_element(block, name, 0, otherwise);
}

bool dalcs_block_has_only(const struct dalcs_block_card *c, const char *const *list, size_t n) {
    bool has_only = true;
    for (int k = 0; k < c->block->n && has_only; k++) {
        const struct dalcs_token *name = c->block->value[k].name;
        has_only = dalcs_builder_is_one_of(name->text, list, n);
        if (!has_only) {
            dalcs_builder_error(c->builder, name,
                                dalcs_builder_suggest_of(c->builder, list, n, name->text, NULL),
                                "%s has no parameter '%s' here", c->block->type->text, name->text);
        }
    }
    return has_only;
}
