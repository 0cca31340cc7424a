/* signal_reading.c - one signal of a card: v(node), i(element), a part of one, a formula, a power. */
#include "reader.h"
#include "result_cards.h"
#include "signals.h"

#include <string.h>

/* A signal that does not exist is left out, as in ngspice and LTspice: the run is the same without it. */
static void leave_out_unknown(struct dalcs_builder *builder, const struct dalcs_token *token) {
    if ((builder->hidden & DALCS_HIDDEN_ELEMENTS) != 0) {
        builder->failed = true;
        return;
    }
    dalcs_builder_warn(
        builder, token,
        dalcs_builder_suggest(builder, &builder->elements.devices, token->text, "elements"),
        "there is no element '%s': it is left out", token->text);
}

static int find_node(struct dalcs_builder *builder, const struct dalcs_token *token) {
    return dalcs_builder_find_node_or_warn(builder, token, "it is left out");
}

static int find_device(struct dalcs_builder *builder, const struct dalcs_token *token) {
    const int device = dalcs_builder_look_up_device(builder, token->text);
    if (device >= builder->elements.n_device_cards) {
        return dalcs_builder_find_device(builder, token); /* a coupling, with a message */
    }
    if (device < 0) {
        leave_out_unknown(builder, token);
    }
    return device;
}

/* gnucap's v(nodes). */
static bool is_every_node(const struct dalcs_builder *builder, const char *name) {
    return strcmp(name, "*") == 0 ||
           (strcmp(name, "nodes") == 0 && dalcs_names_find(&builder->elements.nodes, name) < 0);
}

/* After `v (`: a node or two, and the closing parenthesis. */
static bool read_voltage(struct dalcs_reader *reader) {
    const struct dalcs_token *name[2];
    if (!dalcs_reader_name(reader, "a node", &name[0])) {
        return false;
    }
    if (is_every_node(reader->builder, name[0]->text) &&
        dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        dalcs_signals_add_voltages(reader->builder);
        return true;
    }
    const int a = find_node(reader->builder, name[0]);
    int b = 0;
    const bool is_pair = !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE);
    if (is_pair) {
        if (!dalcs_reader_name(reader, "')' or a second node", &name[1])) {
            return false;
        }
        b = find_node(reader->builder, name[1]);
        if (!dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
            dalcs_reader_missing(reader, "')'");
            return false;
        }
    }
    if (a >= 0 && b >= 0) {
        dalcs_signals_add_voltage(reader->builder, a, b, is_pair);
    }
    return true;
}

static bool read_current(struct dalcs_reader *reader) {
    const struct dalcs_token *name;
    if (!dalcs_reader_name(reader, "the name of an element", &name)) {
        return false;
    }
    if (!dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        dalcs_reader_missing(reader, "')'");
        return false;
    }
    if (strcmp(name->text, "*") == 0) {
        dalcs_signals_add_currents(reader->builder);
        return true;
    }
    const int device = find_device(reader->builder, name);
    if (device >= 0) {
        dalcs_signals_add_current(reader->builder, device);
    }
    return true;
}

/* Xyce prints the values of parameters and of those of elements and models, r1:r and dmod:is. */
static bool is_value(const struct dalcs_builder *builder, const char *name) {
    return strchr(name, ':') != NULL || strcmp(name, "temp") == 0 ||
           dalcs_deck_has_parameter(builder->deck, name);
}

static void leave_out(struct dalcs_builder *builder, const struct dalcs_token *token) {
    dalcs_builder_warn(builder, token, "signals are: v(node) v(a,b) i(element)",
                       "'%s' is a value of the netlist and no signal: it is left out", token->text);
}

/* How a .plot looks. */
static bool is_look(const struct dalcs_card *card, const struct dalcs_token *token) {
    static const char *const looks[] = {"xlog", "ylog", "loglog", "linear", "xlin", "ylin"};
    return strcmp(card->token->text, ".plot") == 0 &&
           dalcs_builder_is_one_of(token->text, looks, sizeof looks / sizeof looks[0]);
}

/* A word without a parenthesis: in ngspice a node's voltage. */
static bool read_plain_node(struct dalcs_reader *reader) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    const int node = dalcs_names_find(&builder->elements.nodes, token->text);
    if (node >= 0) {
        reader->at++;
        dalcs_signals_add_voltage(builder, node, 0, false);
        return true;
    }
    const char *hint = DALCS_SIGNALS_USAGE;
    const char *nearest = dalcs_names_nearest(&builder->elements.nodes, token->text);
    if (is_value(builder, token->text)) {
        reader->at++;
        leave_out(builder, token);
        return true;
    }
    if (dalcs_names_find(&builder->elements.devices, token->text) >= 0) {
        hint = dalcs_builder_hint(builder, "write i(%s)", token->text);
    } else if (nearest != NULL) {
        hint = dalcs_builder_hint(builder, "did you mean 'v(%s)'?", nearest);
    }
    const struct dalcs_token *next = dalcs_reader_peek(reader, 1);
    if (next != NULL && next->kind == DALCS_TOKEN_EQUAL) {
        dalcs_builder_error(builder, token, hint, "'%s' is not a signal", token->text);
        return false;
    }
    reader->at++;
    if (!is_look(reader->card, token)) {
        dalcs_builder_warn(builder, token, hint, "'%s' is not a signal: it is left out",
                           token->text);
    }
    return true;
}

struct part_name {
    const char *name;
    enum dalcs_signal_part part;
};

static const struct part_name *find_part(const struct part_name *part, size_t n, const char *name) {
    for (size_t k = 0; k < n; k++) {
        if (strcmp(part[k].name, name) == 0) {
            return &part[k];
        }
    }
    return NULL;
}

/* v and i, or a part of one of .ac: vm, vp, vr, vi, vdb. The whole is recorded. */
static const struct part_name *part_of(const char *word) {
    static const struct part_name suffix[] = {
        {"", DALCS_PART_PLAIN}, {"m", DALCS_PART_MAGNITUDE}, {"p", DALCS_PART_PHASE},
        {"r", DALCS_PART_REAL}, {"i", DALCS_PART_IMAGINARY}, {"db", DALCS_PART_DECIBEL}};
    return word[0] == 'v' || word[0] == 'i'
               ? find_part(suffix, sizeof suffix / sizeof suffix[0], word + 1)
               : NULL;
}

/* The same around a signal: db(v(out)). */
static const struct part_name *function_of(const char *word) {
    static const struct part_name name[] = {
        {"db", DALCS_PART_DECIBEL}, {"mag", DALCS_PART_MAGNITUDE}, {"abs", DALCS_PART_MAGNITUDE},
        {"ph", DALCS_PART_PHASE},   {"phase", DALCS_PART_PHASE},   {"re", DALCS_PART_REAL},
        {"real", DALCS_PART_REAL},  {"imag", DALCS_PART_IMAGINARY}};
    return find_part(name, sizeof name / sizeof name[0], word);
}

/* @r1[i], as ngspice has the current of an element without a branch of its own. */
static bool read_device_current(struct dalcs_reader *reader) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    struct dalcs_token name = *token;
    const char *bracket = strchr(token->text, '[');
    const bool is_power = bracket != NULL && strcmp(bracket, "[p]") == 0;
    const size_t length =
        is_power ? (size_t)(bracket - token->text) - 1 : dalcs_names_current_of(token->text);
    if (length == 0) {
        dalcs_builder_warn(builder, token,
                           "current and power of an element are recorded: @name[i], @name[p]",
                           "'%s' is not a signal: it is left out", token->text);
        reader->at++;
        return true;
    }
    name.text = dalcs_arena_copy(&builder->scratch, token->text + 1, length);
    if (name.text == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    reader->at++;
    const int device = find_device(builder, &name);
    if (device >= 0 && is_power) {
        if (dalcs_signal_formula_has_power(builder, device)) {
            dalcs_signals_add_power(builder, 'p', device);
        } else {
            dalcs_signals_note_power(builder, token, "");
        }
    } else if (device >= 0) {
        dalcs_signals_add_current(builder, device);
    }
    return true;
}

/* A word with what stands in parentheses behind it. */
static void skip_call(struct dalcs_reader *reader) {
    int depth = 0;
    do {
        reader->at++;
        depth += dalcs_reader_peek(reader, 0)->kind == DALCS_TOKEN_OPEN ? 1 : 0;
        depth -= dalcs_reader_peek(reader, 0)->kind == DALCS_TOKEN_CLOSE ? 1 : 0;
    } while (depth > 0 && dalcs_reader_peek(reader, 1) != NULL);
    reader->at++;
}

/* p(r1), which KiCad writes for every part, w(r1) of PSpice, n(d1:cd) of Xyce: what is inside of models or computed
 * afterwards. */
static void skip_inner(struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    struct dalcs_builder *builder = reader->builder;
    if (dalcs_signals_read_power(reader)) {
        return;
    }
    const struct dalcs_token *name = dalcs_reader_peek(reader, 2);
    const struct dalcs_token *close = dalcs_reader_peek(reader, 3);
    const bool names_element = strcmp(token->text, "n") != 0 && name != NULL &&
                               name->text[0] != 'x' && close != NULL &&
                               close->kind == DALCS_TOKEN_CLOSE;
    if (names_element && find_device(builder, name) < 0) {
        skip_call(reader);
        return;
    }
    if (strcmp(token->text, "n") == 0) {
        dalcs_builder_warn(builder, token, NULL,
                           "what is inside of a model is not recorded: "
                           "n(...) is left out");
    } else {
        dalcs_signals_note_power(builder, token, "(...)");
    }
    skip_call(reader);
}

/* .probe, .probe64, .probe/csdf */
bool dalcs_signals_is_probe(const struct dalcs_card *card) {
    return strncmp(card->token->text, ".probe", strlen(".probe")) == 0;
}

/* A word without brackets: a node, or many signals. */
static bool read_word(struct dalcs_reader *reader) {
    struct dalcs_builder *builder = reader->builder;
    if (dalcs_reader_take_word(reader, "all")) {
        dalcs_signals_add_default(builder);
        return true;
    }
    if (dalcs_reader_take_word(reader, "alli")) {
        if (dalcs_signals_is_probe(reader->card)) {
            dalcs_signals_add_default(builder);
        }
        dalcs_signals_add_currents(builder);
        return true;
    }
    if (dalcs_reader_take_word(reader, "allp")) {
        dalcs_signals_add_powers(builder, 'p');
        return true;
    }
    return dalcs_reader_peek(reader, 0)->text[0] == '@' ? read_device_current(reader)
                                                        : read_plain_node(reader);
}

/* db(v(out)) */
static bool read_function_of(struct dalcs_reader *reader, const struct part_name *function) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    reader->at += 2;
    const struct dalcs_token *inner = dalcs_reader_peek(reader, 0);
    builder->results.print_part = function->part;
    builder->results.print_before = dalcs_builder_hint(builder, "%s(", token->text);
    if (inner == NULL || part_of(inner->text) == NULL) {
        dalcs_reader_missing(reader, "v(node) or i(element)");
        return false;
    }
    if (!dalcs_signals_read(reader)) {
        return false;
    }
    if (!dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        dalcs_reader_missing(reader, "')'");
        return false;
    }
    return true;
}

bool dalcs_signals_read(struct dalcs_reader *reader) {
    static const char *const within[] = {"p", "w", "n"};
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *next = dalcs_reader_peek(reader, 1);
    if (token->kind != DALCS_TOKEN_BAD && dalcs_signals_is_formula(reader)) {
        if (dalcs_signals_read_formula(reader)) {
            return true;
        }
        dalcs_builder_error(builder, token, "{v(a)*i(r1)}; v(a,b) is v(a)-v(b)",
                            "a formula stands in braces here");
        return false;
    }
    if (token->kind != DALCS_TOKEN_WORD) {
        dalcs_reader_unexpected(reader);
        return false;
    }
    if (next == NULL || next->kind != DALCS_TOKEN_OPEN) {
        return read_word(reader);
    }
    if (dalcs_signals_read_all_of(reader)) {
        return true;
    }
    const struct part_name *part = part_of(token->text);
    if (part != NULL) {
        reader->at += 2;
        if (part->part != DALCS_PART_PLAIN) {
            builder->results.print_part = part->part;
            builder->results.print_before = token->text;
        }
        return token->text[0] == 'v' ? read_voltage(reader) : read_current(reader);
    }
    if (dalcs_builder_is_one_of(token->text, within, sizeof within / sizeof within[0])) {
        skip_inner(reader);
        return true;
    }
    const struct part_name *function = function_of(token->text);
    if (function != NULL) {
        return read_function_of(reader, function);
    }
    dalcs_builder_warn(builder, token, DALCS_SIGNALS_USAGE,
                       "'%s(...)' is not a signal: it is left out", token->text);
    skip_call(reader);
    return true;
}
