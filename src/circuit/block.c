/* block.c - cards of XSPICE's code models: parameters of the model, ports of the element.
 *
 *     Aname port port ... model      port: node, ~node, %v node, %vd(node node), [node node ...], null
 */
#include "block.h"

#include "number.h"
#include "reader.h"

#include <string.h>

static const char USAGE[] = "a code model is: Aname port ... model, a port being a node, "
                            "%vd(node node) or a list [node node ...]";

/* ---- The model ------------------------------------------------------------------------------------------ */

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

/* ---- Ports ------------------------------------------------------------------------------------------------ */

/* The state of reading a list. */
struct port_reader {
    struct dalcs_reader *reader;
    bool is_difference; /* %vd */
    int bracket;
};

/* The node of a word without its brackets and ~. */
static bool read_node(struct port_reader *p, struct dalcs_block_end *end, int *node,
                      bool is_first) {
    struct dalcs_builder *builder = p->reader->builder;
    const struct dalcs_token *token = dalcs_reader_peek(p->reader, 0);
    if (token == NULL || token->kind != DALCS_TOKEN_WORD ||
        p->reader->at >= p->reader->card->n - 1) {
        dalcs_builder_error(builder, p->reader->card->token, USAGE, "a node of a port is missing");
        return false;
    }
    p->reader->at++;
    const char *text = token->text;
    for (; *text == '[' || *text == '~'; text++) {
        p->bracket += *text == '[';
        end->is_inverted = end->is_inverted != (*text == '~');
    }
    const size_t n = strcspn(text, "]");
    p->bracket -= (int)strlen(text + n);
    struct dalcs_token *name = dalcs_arena_alloc(&builder->scratch, 1, sizeof *name);
    const char *own = dalcs_builder_hint(builder, "%.*s", (int)n, text);
    if (name == NULL || own == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    *name = *token;
    name->text = own;
    if (n == 0) { /* a bracket that stands alone */
        if (p->bracket > 0 && (p->reader->at < p->reader->card->n - 1)) {
            return read_node(p, end, node, is_first);
        }
        end->is_null = true;
        return true;
    }
    end->token = is_first ? name : end->token;
    end->is_null = strcmp(own, "null") == 0;
    *node = end->is_null ? 0 : dalcs_builder_node(builder, name);
    return *node >= 0;
}

static bool read_type(struct port_reader *p) {
    static const char *const voltages[] = {"%v", "%vd", "%d", "%gd"};
    const struct dalcs_token *token = dalcs_reader_peek(p->reader, 0);
    if (token == NULL || token->text[0] != '%') {
        return true;
    }
    if (!dalcs_builder_is_one_of(token->text, voltages, 4)) {
        dalcs_builder_error(p->reader->builder, token, "write %v or %vd, and F or H for a current",
                            "ports of type '%s' are not supported", token->text);
        return false;
    }
    p->is_difference = token->text[strlen(token->text) - 1] == 'd' && token->text[1] != 'd';
    p->reader->at++;
    return true;
}

static bool read_end(struct port_reader *p, struct dalcs_block_end *end) {
    if (!read_type(p)) {
        return false;
    }
    const bool is_open = dalcs_reader_take(p->reader, DALCS_TOKEN_OPEN);
    if (!read_node(p, end, &end->node, true)) {
        return false;
    }
    if (end->token == NULL && end->is_null) {
        return true; /* the bracket that ends a list */
    }
    const struct dalcs_token *next = dalcs_reader_peek(p->reader, 0);
    const bool is_pair = is_open && next != NULL && next->kind != DALCS_TOKEN_CLOSE;
    if ((p->is_difference || is_pair) && !read_node(p, end, &end->reference, false)) {
        return false;
    }
    if (is_open && !dalcs_reader_take(p->reader, DALCS_TOKEN_CLOSE)) {
        dalcs_reader_missing(p->reader, "')'");
        return false;
    }
    return true;
}

static bool read_port(struct dalcs_reader *reader, struct dalcs_block_port *port) {
    struct port_reader p = {.reader = reader};
    port->end =
        dalcs_arena_alloc(&reader->builder->scratch, (size_t)reader->card->n, sizeof *port->end);
    if (port->end == NULL) {
        reader->builder->out_of_memory = true;
        return false;
    }
    do {
        if (!read_end(&p, &port->end[port->n])) {
            return false;
        }
        port->is_list = port->is_list || p.bracket > 0 || port->n > 0;
        port->n += !(port->end[port->n].is_null && port->end[port->n].token == NULL);
    } while (p.bracket > 0);
    return true;
}

bool dalcs_block_has_ports(const struct dalcs_block_card *c, int n, int n_optional,
                           const char *usage) {
    if (c->n_ports >= n && c->n_ports <= n + n_optional) {
        return true;
    }
    dalcs_builder_error(c->builder, c->card->token, usage, "'%s' has %d ports, %s has %d",
                        c->card->token->text, c->n_ports, c->block->type->text, n + n_optional);
    return false;
}

bool dalcs_block_has_nodes(const struct dalcs_block_card *c, const char *usage) {
    for (int k = 0; k < c->n_ports; k++) {
        for (int i = 0; i < c->port[k].n; i++) {
            if (c->port[k].end[i].is_null || c->port[k].end[i].is_inverted) {
                dalcs_builder_error(c->builder, c->card->token, usage,
                                    "a port of '%s' must be a node", c->card->token->text);
                return false;
            }
        }
    }
    return true;
}

void dalcs_block_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                       const struct dalcs_block *block) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_block_card c = {.builder = builder, .card = card, .block = block};
    const int type = find_type(block->type->text);
    bool ok = true;
    if (strcmp(TYPES[type].type, "transformer") == 0) {
        dalcs_transformer_parse(builder, card, block);
        return;
    }
    if (TYPES[type].because != NULL) {
        dalcs_builder_error(builder, card->token, TYPES[type].hint, "%s is not supported: %s",
                            TYPES[type].type, TYPES[type].because);
        ok = false;
    }
    while (ok && reader.at < card->n - 1) {
        ok = c.n_ports < DALCS_BLOCK_PORTS && read_port(&reader, &c.port[c.n_ports]);
        if (c.n_ports == DALCS_BLOCK_PORTS) {
            dalcs_builder_error(builder, card->token, USAGE, "'%s' has more than %d ports",
                                card->token->text, DALCS_BLOCK_PORTS);
        }
        c.n_ports++;
    }
    if (!ok || (!dalcs_block_parse_logic(&c) && !dalcs_block_parse_analog(&c) &&
                !dalcs_block_parse_formula(&c) && !dalcs_block_parse_oscillator(&c))) {
        builder->hidden |= DALCS_HIDDEN_ELEMENTS;
    }
}
