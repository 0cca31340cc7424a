/* block_ports.c - the ports of a code model on its element.
 *
 *     Aname port port ... model      port: node, ~node, %v node, %vd(node node), [node node ...], null
 */
#include "block.h"

#include "reader.h"

#include <string.h>

static const char USAGE[] = "a code model is: Aname port ... model, a port being a node, "
                            "%vd(node node) or a list [node node ...]";

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
    if (strcmp(block->type->text, "transformer") == 0) {
        dalcs_transformer_parse(builder, card, block);
        return;
    }
    bool ok = !dalcs_block_is_refused(builder, card, block);
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
