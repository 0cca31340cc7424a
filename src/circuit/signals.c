/* signals.c - what is recorded: .save, .print, .plot and .probe, or the default.
 *
 * The default is every node voltage and the currents of V, L, D, S, W, E, H and
 * B with V=. Naming signals
 * replaces it, `all` adds it. Each signal is recorded once. */
#include "builder.h"

#include <string.h>

static const char USAGE[] = "signals are: v(node) v(a,b) i(element) all";

/* A column of the .print that is being read. */
static void add_column(struct dalcs_builder *builder, const char *name) {
    const char *before = builder->print_before;
    const bool is_function = before != NULL && strchr(before, '(') != NULL;
    const char *title =
        before == NULL ? name
                       : dalcs_arena_printf(&builder->circuit->arena, "%s%s%s", before,
                                            is_function ? name : name + 1, is_function ? ")" : "");
    if (title == NULL ||
        dalcs_grow(&builder->print_column, &builder->print_column_capacity,
                   builder->n_print_columns + 1, sizeof *builder->print_column) != DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    builder->print_column[builder->n_print_columns++] =
        (struct dalcs_print_column){name, title, builder->print_part};
    builder->print[builder->n_prints - 1].n++;
}

/* Adds a signal; `name` is in the circuit's arena or NULL when memory ran out. The defaults alone
 * hold nothing twice, and a million names are better not looked up. */
static void add_signal(struct dalcs_builder *builder, const char *name,
                       struct dalcs_signal signal) {
    const bool may_repeat = builder->names_signals;
    if (name != NULL && builder->is_print) {
        add_column(builder, name);
    }
    if (name != NULL && may_repeat && dalcs_names_find(&builder->signals, name) >= 0) {
        return;
    }
    signal.name = name;
    if (name == NULL || (may_repeat && dalcs_names_add(&builder->signals, name, 0) != DALCS_OK) ||
        dalcs_grow(&builder->signal, &builder->signal_capacity, builder->n_signals + 1,
                   sizeof *builder->signal) != DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    builder->signal[builder->n_signals++] = signal;
}

static const char *node_text(const struct dalcs_builder *builder, int node) {
    return node == 0 ? "0" : builder->node_name[node];
}

/* "v(out)" or "i(r1)"; a million of them by printf take as long as to read their netlist. */
static const char *signal_name(const struct dalcs_builder *builder, char letter,
                               const char *inside) {
    const size_t n = strlen(inside);
    char *name = dalcs_arena_text(&builder->circuit->arena, n + 3);
    if (name != NULL) {
        name[0] = letter;
        name[1] = '(';
        memcpy(name + 2, inside, n);
        name[2 + n] = ')';
    }
    return name;
}

static void add_voltage(struct dalcs_builder *builder, int a, int b, bool is_pair) {
    const char *name = is_pair ? dalcs_arena_printf(&builder->circuit->arena, "v(%s,%s)",
                                                    node_text(builder, a), node_text(builder, b))
                               : signal_name(builder, 'v', node_text(builder, a));
    add_signal(builder, name,
               (struct dalcs_signal){.kind = DALCS_SIGNAL_VOLTAGE, .node = {a, b}, .device = -1});
}

static void add_current(struct dalcs_builder *builder, int device) {
    const struct dalcs_device *d = &builder->circuit->device[device];
    const bool is_bend = d->is_storage && dalcs_builder_is_inner(d->name); /* of a coil */
    const int named = is_bend ? builder->current_of[device] : device;
    const char *name = signal_name(builder, 'i', builder->circuit->device[named].name);
    add_signal(
        builder, name,
        (struct dalcs_signal){.kind = DALCS_SIGNAL_CURRENT, .device = builder->current_of[device]});
}

/* By letter, not by kind: an inductor of 0 H is still an inductor to the one who wrote it. */
static bool has_default(const struct dalcs_device *d) {
    const bool is_default = (d->letter != 0 && strchr("vldsweh", d->letter) != NULL) ||
                            d->kind == DALCS_DIODE || d->kind == DALCS_SWITCH ||
                            (d->letter == 'b' && d->kind == DALCS_VCVS);
    return is_default && !dalcs_builder_is_inner(d->name);
}

static void add_voltages(struct dalcs_builder *builder) {
    for (int k = 1; k < builder->circuit->n_nodes; k++) {
        if (!dalcs_builder_is_inner(builder->node_name[k])) {
            add_voltage(builder, k, 0, false);
        }
    }
}

void dalcs_signals_add_default(struct dalcs_builder *builder) {
    const struct dalcs_circuit *circuit = builder->circuit;
    size_t need = builder->n_signals + (size_t)circuit->n_nodes - 1;
    for (int k = 0; k < circuit->n_devices; k++) {
        need += has_default(&circuit->device[k]);
    }
    if (dalcs_grow(&builder->signal, &builder->signal_capacity, need, sizeof *builder->signal) !=
        DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    add_voltages(builder);
    for (int k = 0; k < circuit->n_devices; k++) {
        if (has_default(&circuit->device[k])) {
            add_current(builder, k);
        }
    }
}

/* ngspice's alli and LTspice's i(*): the current of each element. */
void dalcs_signals_add_currents(struct dalcs_builder *builder) {
    for (int k = 0; k < builder->circuit->n_devices; k++) {
        if (!dalcs_builder_is_inner(builder->circuit->device[k].name)) {
            add_current(builder, k);
        }
    }
}

int dalcs_signals_measure(struct dalcs_builder *builder, struct dalcs_signal signal) {
    const char *key = signal.kind == DALCS_SIGNAL_CURRENT
                          ? dalcs_builder_hint(builder, "%d", signal.device)
                          : dalcs_builder_hint(builder, "%d %d", signal.node[0], signal.node[1]);
    const int next = (int)builder->n_measured;
    int place;
    if (signal.name == NULL || key == NULL ||
        dalcs_names_find_or_add(&builder->measured_keys, key, next, &place) != DALCS_OK ||
        dalcs_grow(&builder->measured, &builder->measured_capacity, builder->n_measured + 1,
                   sizeof *builder->measured) != DALCS_OK) {
        builder->out_of_memory = true;
        return -1;
    }
    if (place == next) {
        builder->measured[builder->n_measured++] = signal;
    }
    return place;
}

/* A signal that does not exist is left out, as in ngspice and LTspice: the run is the same without it. */
static void leave_out_unknown(struct dalcs_builder *builder, const struct dalcs_token *token,
                              const struct dalcs_names *names, const char *what,
                              const char *message) {
    if ((builder->hidden & DALCS_HIDDEN_ELEMENTS) != 0) {
        builder->failed = true;
        return;
    }
    dalcs_builder_warn(builder, token, dalcs_builder_suggest(builder, names, token->text, what),
                       message, token->text);
}

static int find_node(struct dalcs_builder *builder, const struct dalcs_token *token) {
    const int node = dalcs_builder_look_up_node(builder, token->text);
    if (node < 0) {
        leave_out_unknown(builder, token, &builder->nodes, "nodes",
                          "no element is connected to a node '%s': it is left out");
    }
    return node;
}

static int find_device(struct dalcs_builder *builder, const struct dalcs_token *token) {
    const int device = dalcs_builder_look_up_device(builder, token->text);
    if (device >= builder->n_device_cards) {
        return dalcs_builder_find_device(builder, token); /* a coupling, with a message */
    }
    if (device < 0) {
        leave_out_unknown(builder, token, &builder->devices, "elements",
                          "there is no element '%s': it is left out");
    }
    return device;
}

/* gnucap's v(nodes). */
static bool is_every_node(const struct dalcs_builder *builder, const char *name) {
    return strcmp(name, "*") == 0 ||
           (strcmp(name, "nodes") == 0 && dalcs_names_find(&builder->nodes, name) < 0);
}

/* After `v (`: a node or two, and the closing parenthesis. */
static bool read_voltage(struct dalcs_reader *reader) {
    const struct dalcs_token *name[2];
    if (!dalcs_reader_name(reader, "a node", &name[0])) {
        return false;
    }
    if (is_every_node(reader->builder, name[0]->text) &&
        dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        add_voltages(reader->builder);
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
        add_voltage(reader->builder, a, b, is_pair);
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
        add_current(reader->builder, device);
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
    const int node = dalcs_names_find(&builder->nodes, token->text);
    if (node >= 0) {
        reader->at++;
        add_voltage(builder, node, 0, false);
        return true;
    }
    const char *hint = USAGE;
    const char *nearest = dalcs_names_nearest(&builder->nodes, token->text);
    if (is_value(builder, token->text)) {
        reader->at++;
        leave_out(builder, token);
        return true;
    }
    if (dalcs_names_find(&builder->devices, token->text) >= 0) {
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

/* {v(a)*2}, par('...'), name=par('...'), and what follows a signal in v(a)-v(b). */
static bool is_formula(const struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *next = dalcs_reader_peek(reader, 1);
    const char first = token->text[0]; /* KiCad's nodes may begin with a slash */
    const bool is_operator = first != '\0' && strchr("+-*/", first) != NULL &&
                             dalcs_names_find(&reader->builder->nodes, token->text) < 0;
    if (next != NULL && next->kind == DALCS_TOKEN_EQUAL && dalcs_reader_peek(reader, 2) != NULL) {
        token = dalcs_reader_peek(reader, 2); /* name=formula */
        next = dalcs_reader_peek(reader, 3);
    }
    const bool is_par =
        strcmp(token->text, "par") == 0 && next != NULL && next->kind == DALCS_TOKEN_OPEN;
    return is_operator || is_par || token->kind == DALCS_TOKEN_EXPRESSION ||
           token->kind == DALCS_TOKEN_FORMULA;
}

/* A sum of signals and numbers with constant factors? */
static bool is_affine(const struct dalcs_formula *f) {
    const enum dalcs_operation_code code = f->code;
    bool all = true;
    for (int k = 0; k < f->n; k++) {
        all = all && is_affine(f->argument[k]);
    }
    const bool is_first_number = f->n > 0 && f->argument[0]->kind == DALCS_FORMULA_NUMBER;
    const bool is_last_number = f->n > 0 && f->argument[f->n - 1]->kind == DALCS_FORMULA_NUMBER;
    switch (f->kind) {
    case DALCS_FORMULA_NUMBER:
    case DALCS_FORMULA_VOLTAGE:
    case DALCS_FORMULA_CURRENT:
        return true;
    case DALCS_FORMULA_OPERATION:
        return all && (code == DALCS_NEGATE || code == DALCS_ADD || code == DALCS_SUBTRACT ||
                       (code == DALCS_MULTIPLY && (is_first_number || is_last_number)) ||
                       (code == DALCS_DIVIDE && is_last_number));
    default:
        return false;
    }
}

/* "{v(a)-v(b)}" without blanks: the name of its signal. */
static const char *formula_name(struct dalcs_builder *builder, const struct dalcs_formula *f) {
    const char *text = f->text->text;
    char *name = dalcs_arena_text(&builder->circuit->arena, strlen(text) + 2);
    size_t n = 0;
    if (name == NULL) {
        return NULL;
    }
    name[n++] = '{';
    for (; *text != '\0'; text++) {
        if (*text != ' ' && *text != '\t') {
            name[n++] = *text;
        }
    }
    name[n++] = '}';
    name[n] = '\0';
    return name;
}

/* A column that is computed, once for each name. */
static void add_computed(struct dalcs_builder *builder, const char *name,
                         const struct dalcs_signal_formula *formula) {
    if (builder->is_print) {
        add_column(builder, name);
    }
    if (dalcs_names_find(&builder->signals, name) >= 0) {
        return;
    }
    if (dalcs_names_add(&builder->signals, name, 0) != DALCS_OK ||
        dalcs_grow(&builder->computed, &builder->computed_capacity, builder->n_computed + 1,
                   sizeof *builder->computed) != DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    builder->computed[builder->n_computed++] =
        (struct dalcs_computed){name, (int)builder->n_signals, *formula};
}

/* w(r1) or p(r1), of an element that has one. */
static void add_power_column(struct dalcs_builder *builder, char letter, int device) {
    struct dalcs_signal_formula formula;
    const char *name = dalcs_arena_printf(&builder->circuit->arena, "%c(%s)", letter,
                                          builder->circuit->device[device].name);
    builder->out_of_memory = builder->out_of_memory || name == NULL;
    if (name != NULL && dalcs_computed_power(builder, device, &formula)) {
        add_computed(builder, name, &formula);
    }
}

static void note_power(struct dalcs_builder *builder, const struct dalcs_token *token,
                       const char *argument) {
    if (!builder->noted_power) {
        dalcs_builder_note(
            builder, token, "{v(a,b)*i(x)} is that of two terminals",
            "a power that is not one voltage times one current is not recorded: %s%s is left out",
            token->text, argument);
        builder->noted_power = true;
    }
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
            add_power_column(builder, 'p', device);
        } else {
            note_power(builder, token, "");
        }
    } else if (device >= 0) {
        add_current(builder, device);
    }
    return true;
}

/* A formula of signals: one that is affine is the voltage of a source that nothing loads, others are computed. */
static void add_formula(struct dalcs_builder *builder, const struct dalcs_token *token) {
    const char *name = formula_name(builder, token->formula);
    if (name == NULL) {
        builder->out_of_memory = true;
        return;
    }
    if (!is_affine(token->formula)) {
        struct dalcs_signal_formula formula;
        if (dalcs_computed_compile(builder, token->formula, &formula)) {
            add_computed(builder, name, &formula);
        } else if (!builder->failed && !builder->out_of_memory) {
            dalcs_builder_warn(builder, token, "B1 x 0 V={formula} makes a node of it",
                               "this formula cannot be computed from a row: it is left out");
        }
        return;
    }
    struct dalcs_token *named = dalcs_arena_alloc(&builder->scratch, 1, sizeof *named);
    if (named == NULL) {
        builder->out_of_memory = true;
        return;
    }
    *named = *token;
    named->kind = DALCS_TOKEN_WORD;
    named->text = name;
    const bool is_known = dalcs_names_find(&builder->signals, name) >= 0;
    const int node = is_known ? 0 : dalcs_behavioural_add_readout(builder, token, "readout", named);
    if (node >= 0) {
        add_signal(
            builder, name,
            (struct dalcs_signal){.kind = DALCS_SIGNAL_VOLTAGE, .node = {node, 0}, .device = -1});
    }
}

/* {formula}, par('formula') and name=par('formula'); false: another form. */
static bool read_formula(struct dalcs_reader *reader) {
    const int at = reader->at;
    (void)dalcs_reader_take_parameter(reader);
    const bool is_par =
        dalcs_reader_take_word(reader, "par") && dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    const bool ok = token != NULL && token->kind == DALCS_TOKEN_FORMULA;
    reader->at += ok;
    if (!ok || (is_par && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE))) {
        reader->at = at;
        return false;
    }
    add_formula(reader->builder, token);
    return true;
}

static void add_power(struct dalcs_builder *builder, char letter, int device) {
    struct dalcs_signal_formula formula;
    const char *own = dalcs_arena_printf(&builder->circuit->arena, "%c(%s)", letter,
                                         builder->circuit->device[device].name);
    builder->out_of_memory = builder->out_of_memory || own == NULL;
    if (own != NULL && dalcs_computed_power(builder, device, &formula)) {
        add_computed(builder, own, &formula);
    }
}

/* Of each element that has one: ngspice's allp, PSpice's w(alias(*)). */
static void add_powers(struct dalcs_builder *builder, char letter) {
    for (int k = 0; k < builder->circuit->n_devices; k++) {
        if (!dalcs_builder_is_inner(builder->circuit->device[k].name) &&
            dalcs_signal_formula_has_power(builder, k)) {
            add_power(builder, letter, k);
        }
    }
}

/* v(alias(*)), i(alias(*)), w(alias(*)) on PSpice's .probe: all of them; d(...) and noise(...): nothing that there is
 * here. False: another form. */
static bool read_all_of(struct dalcs_reader *reader) {
    static const char *const begin[] = {"(", "alias", "(", "*", ")", ")"};
    struct dalcs_builder *builder = reader->builder;
    const char letter = dalcs_reader_peek(reader, 0)->text[0];
    for (int k = 0; k < 6; k++) {
        const struct dalcs_token *token = dalcs_reader_peek(reader, k + 1);
        if (token == NULL || strcmp(token->text, begin[k]) != 0) {
            return false;
        }
    }
    reader->at += 7;
    if (letter == 'v') {
        add_voltages(builder);
    } else if (letter == 'i') {
        dalcs_signals_add_currents(builder);
    } else if (letter == 'w') {
        add_powers(builder, letter);
    }
    return true;
}

/* w(r1) or p(r1) of an element with two terminals, whose power is that of its own voltage; false: of another. */
static bool read_power(struct dalcs_reader *reader) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *letter = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *name = dalcs_reader_peek(reader, 2);
    const struct dalcs_token *close = dalcs_reader_peek(reader, 3);
    if (letter->text[0] == 'n' || name == NULL || close == NULL ||
        close->kind != DALCS_TOKEN_CLOSE) {
        return false;
    }
    const int device = dalcs_names_find(&builder->devices, name->text);
    if (device < 0 || !dalcs_signal_formula_has_power(builder, device)) {
        return false;
    }
    add_power_column(builder, letter->text[0], device);
    reader->at += 4;
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
    if (read_power(reader)) {
        return;
    }
    if (strcmp(token->text, "n") == 0) {
        dalcs_builder_warn(builder, token, NULL,
                           "what is inside of a model is not recorded: "
                           "n(...) is left out");
    } else {
        note_power(builder, token, "(...)");
    }
    skip_call(reader);
}

/* .probe, .probe64, .probe/csdf */
static bool is_probe(const struct dalcs_card *card) {
    return strncmp(card->token->text, ".probe", strlen(".probe")) == 0;
}

static bool read_signal(struct dalcs_reader *reader) {
    static const char *const within[] = {"p", "w", "n"};
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *next = dalcs_reader_peek(reader, 1);
    if (token->kind != DALCS_TOKEN_BAD && is_formula(reader)) {
        if (read_formula(reader)) {
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
        if (dalcs_reader_take_word(reader, "all")) {
            dalcs_signals_add_default(builder);
            return true;
        }
        if (dalcs_reader_take_word(reader, "alli")) {
            if (is_probe(reader->card)) {
                dalcs_signals_add_default(builder);
            }
            dalcs_signals_add_currents(builder);
            return true;
        }
        if (dalcs_reader_take_word(reader, "allp")) {
            add_powers(builder, 'p');
            return true;
        }
        return token->text[0] == '@' ? read_device_current(reader) : read_plain_node(reader);
    }
    if (read_all_of(reader)) {
        return true;
    }
    const struct part_name *part = part_of(token->text);
    if (part != NULL) {
        reader->at += 2;
        if (part->part != DALCS_PART_PLAIN) {
            builder->print_part = part->part;
            builder->print_before = token->text;
        }
        return token->text[0] == 'v' ? read_voltage(reader) : read_current(reader);
    }
    if (dalcs_builder_is_one_of(token->text, within, sizeof within / sizeof within[0])) {
        skip_inner(reader);
        return true;
    }
    const struct part_name *function = function_of(token->text);
    if (function != NULL) {
        reader->at += 2;
        const struct dalcs_token *inner = dalcs_reader_peek(reader, 0);
        builder->print_part = function->part;
        builder->print_before = dalcs_builder_hint(builder, "%s(", token->text);
        if (inner == NULL || part_of(inner->text) == NULL) {
            dalcs_reader_missing(reader, "v(node) or i(element)");
            return false;
        }
        if (!read_signal(reader)) {
            return false;
        }
        if (!dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
            dalcs_reader_missing(reader, "')'");
            return false;
        }
        return true;
    }
    dalcs_builder_warn(builder, token, USAGE, "'%s(...)' is not a signal: it is left out",
                       token->text);
    skip_call(reader);
    return true;
}

/* Xyce's `format=csv`, `file=name` and the like on .print: how a file looks is said when dalcs is called. */
static void skip_print_options(struct dalcs_reader *reader) {
    static const char *const name[] = {"format",    "file",   "width",          "precision",
                                       "delimiter", "filter", "timescalefactor"};
    for (;;) {
        const struct dalcs_token *option = dalcs_reader_peek(reader, 0);
        if (option == NULL ||
            !dalcs_builder_is_one_of(option->text, name, sizeof name / sizeof name[0]) ||
            dalcs_reader_take_parameter(reader) == NULL) {
            return;
        }
        dalcs_builder_note(reader->builder, option, "files and formats are options: -o out.csv",
                           "%s= on .print is ignored", option->text);
        reader->at += dalcs_reader_at_end(reader) ? 0 : 1;
    }
}

/* `(0,5)` after a signal of .plot: its limits. */
static void skip_limits(struct dalcs_reader *reader) {
    const struct dalcs_token *open = dalcs_reader_peek(reader, 0);
    if (strcmp(reader->card->token->text, ".plot") != 0 || open == NULL ||
        open->kind != DALCS_TOKEN_OPEN) {
        return;
    }
    while (!dalcs_reader_at_end(reader) && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        reader->at++;
    }
}

/* The table of a .print: of one analysis, or of all. */
static bool start_print(struct dalcs_builder *builder, int analysis) {
    if (dalcs_grow(&builder->print, &builder->print_capacity, builder->n_prints + 1,
                   sizeof *builder->print) != DALCS_OK) {
        builder->out_of_memory = true;
        return false;
    }
    struct dalcs_print_card *print = &builder->print[builder->n_prints++];
    *print = (struct dalcs_print_card){0};
    for (int k = 0; k <= DALCS_MEASURED_AC; k++) {
        print->is_of[k] = analysis < 0 || k == analysis;
    }
    return true;
}

void dalcs_signals_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    static const char *const ours[] = {[DALCS_MEASURED_TRAN] = "tran",
                                       [DALCS_MEASURED_OP] = "op",
                                       [DALCS_MEASURED_DC] = "dc",
                                       [DALCS_MEASURED_AC] = "ac"};
    static const char *const other[] = {"noise", "sens",     "hb",        "four",
                                        "hb_ic", "homotopy", "hb_startup"};
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    const struct dalcs_token *type = dalcs_reader_peek(&reader, 0);
    builder->names_signals = true;
    const char *name = card->token->text;
    const bool takes_options = strcmp(name, ".print") == 0;
    const bool has_type = strcmp(name, ".save") != 0;
    for (size_t k = 0; has_type && k < sizeof other / sizeof other[0]; k++) {
        if (dalcs_reader_take_word(&reader, other[k])) {
            dalcs_builder_note(builder, type, NULL, "there is no %s analysis: this is ignored",
                               type->text);
            return;
        }
    }
    int analysis = -1;
    for (int k = 0; has_type && k <= DALCS_MEASURED_AC && analysis < 0; k++) {
        analysis = dalcs_reader_take_word(&reader, ours[k]) ? k : -1;
    }
    if (takes_options) {
        skip_print_options(&reader);
    }
    if (dalcs_reader_at_end(&reader)) {
        /* A bare .probe records everything, as in PSpice. */
        if (is_probe(card)) {
            dalcs_signals_add_default(builder);
        } else {
            dalcs_reader_missing(&reader, "a signal");
        }
        return;
    }
    const bool is_print = strcmp(name, ".print") == 0 || strcmp(name, ".plot") == 0;
    if (is_print && !start_print(builder, analysis)) {
        return;
    }
    builder->is_print = is_print;
    while (!dalcs_reader_at_end(&reader)) {
        builder->print_before = NULL;
        builder->print_part = DALCS_PART_PLAIN;
        if (!read_signal(&reader)) {
            break;
        }
        skip_limits(&reader);
        if (takes_options) {
            skip_print_options(&reader);
        }
    }
    builder->is_print = false;
}
