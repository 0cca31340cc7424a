/* signal_mask.c - signals in the text of a formula: v(...), i(...), powers and names.
 *
 * The parser of expressions knows no signals. Each is masked by a name of the same length that no
 * netlist can have, so that all places stay what they are. */
#include "signal_formula_card.h"

#include "signal_names.h"

#include <string.h>

static const char USAGE[] = "signals are: v(node) v(a,b) i(element)";

enum { MASK = 0xff, DIGITS = 36, MOST_SIGNALS = DIGITS * DIGITS * DIGITS };

static void report(struct dalcs_signal_compilation *c, int begin, int length, const char *hint,
                   const char *format, ...) __attribute__((format(printf, 5, 6)));

static void report(struct dalcs_signal_compilation *c, int begin, int length, const char *hint,
                   const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    dalcs_signal_compilation_report(c, &c->text, begin, length, hint, format, arguments);
    va_end(arguments);
}

/* The word text[begin..end-1] as a token of its line. */
static bool make_token(struct dalcs_signal_compilation *c, int begin, int end,
                       struct dalcs_token *token) {
    const char *text = c->text.text;
    while (begin < end && text[begin] == ' ') {
        begin++;
    }
    while (end > begin && text[end - 1] == ' ') {
        end--;
    }
    int k = c->text.n_pieces - 1;
    while (k > 0 && c->text.piece[k].begin > begin) {
        k--;
    }
    const struct dalcs_piece *piece = &c->text.piece[k];
    *token = (struct dalcs_token){
        .line = piece->line,
        .text = dalcs_arena_copy(&c->builder->scratch, text + begin, (size_t)(end - begin)),
        .offset = piece->offset + begin - piece->begin,
        .length = end > begin ? end - begin : 1,
        .kind = DALCS_TOKEN_WORD};
    c->builder->out_of_memory = c->builder->out_of_memory || token->text == NULL;
    if (token->text != NULL && end <= begin) {
        report(c, begin, 1, USAGE, "a name is missing");
    }
    return token->text != NULL && !c->failed;
}

int dalcs_signal_compilation_find(struct dalcs_signal_compilation *c, bool is_current,
                                  const struct dalcs_token *first,
                                  const struct dalcs_token *second) {
    struct dalcs_builder *builder = c->builder;
    struct dalcs_signal signal = {.kind = DALCS_SIGNAL_VOLTAGE, .device = -1};
    bool found;
    if (is_current) {
        const int device = dalcs_builder_find_device(builder, first);
        found = device >= 0;
        signal.kind = DALCS_SIGNAL_CURRENT;
        signal.device = found ? builder->elements.current_of[device] : -1;
    } else {
        signal.node[0] = dalcs_builder_find_node(builder, first);
        signal.node[1] = second != NULL ? dalcs_builder_find_node(builder, second) : 0;
        found = signal.node[0] >= 0 && signal.node[1] >= 0;
    }
    if (!found) {
        c->failed = true;
        return -1;
    }
    signal.name = dalcs_arena_printf(&builder->circuit->arena, "%c(%s%s%s)", is_current ? 'i' : 'v',
                                     first->text, second != NULL ? "," : "",
                                     second != NULL ? second->text : "");
    return dalcs_signals_measure(builder, signal);
}

/* The signal whose names stand in text[begin..end-1]; -1 when an error was reported. */
static int find_signal(struct dalcs_signal_compilation *c, bool is_current, int begin, int end) {
    const char *text = c->text.text;
    const char *comma = memchr(text + begin, ',', (size_t)(end - begin));
    const int first_end = comma != NULL ? (int)(comma - text) : end;
    struct dalcs_token name[2];
    if (!make_token(c, begin, first_end, &name[0]) ||
        (comma != NULL && !make_token(c, first_end + 1, end, &name[1]))) {
        return -1;
    }
    if (is_current && comma != NULL) {
        report(c, begin, end - begin, USAGE, "a current is that of one element");
        return -1;
    }
    return dalcs_signal_compilation_find(c, is_current, &name[0], comma != NULL ? &name[1] : NULL);
}

/* Writes over v(...) a name that says which of this formula's signals it is. */
static void mask(struct dalcs_signal_compilation *c, int begin, int end) {
    int number = c->n_signals;
    c->masked[begin] = (char)MASK;
    for (int k = begin + 1; k < end; k++) {
        const int digit = number % DIGITS;
        c->masked[k] = (char)(digit < 26 ? 'a' + digit : '0' + digit - 26);
        number /= DIGITS;
    }
}

int dalcs_signal_compilation_unmask(const char *name) {
    int number = 0;
    if ((unsigned char)name[0] != MASK) {
        return -1;
    }
    for (int k = 3; k >= 1; k--) {
        const int digit = name[k] >= 'a' ? name[k] - 'a' : name[k] - '0' + 26;
        number = DIGITS * number + digit;
    }
    return number;
}

static int previous_byte(const char *text, int k) {
    while (k > 0 && text[k - 1] == ' ') {
        k--;
    }
    return k > 0 ? (unsigned char)text[k - 1] : 0;
}

/* A signal in the text. */
struct found {
    int begin, end;     /* what stands for it, a function around it included */
    int name, name_end; /* what its parentheses or its @...[i] hold */
    int open;           /* the parenthesis, -1: none */
    bool is_current, is_power;
    enum dalcs_signal_part part;
};

/* w(r1) and p(r1) in time: the bytes before the parenthesis, 0 when none starts at t, or a function of the netlist. */
static int power_prefix(const struct dalcs_signal_compilation *c, const char *t) {
    const size_t blanks = *t == 'w' || *t == 'p' ? strspn(t + 1, " ") : 0;
    const char name[2] = {*t, '\0'};
    const struct dalcs_expression *body;
    int n;
    if ((*t != 'w' && *t != 'p') || t[1 + blanks] != '(' ||
        strcmp(c->rules->variable, "time") != 0 ||
        dalcs_deck_function(c->builder->deck, name, &n, &body, &c->builder->out_of_memory)) {
        return 0;
    }
    return (int)(1 + blanks);
}

/* Does a signal start at k? Of one whose parenthesis is never closed `end` is behind the text. */
static bool find_at(const struct dalcs_signal_compilation *c, int k, struct found *found) {
    const char *text = c->text.text;
    const bool starts = k == 0 || !dalcs_signal_is_name_byte(text[k - 1]);
    *found = (struct found){.begin = k, .part = DALCS_PART_PLAIN};
    int prefix = starts ? dalcs_signal_prefix(text + k, &found->part) : 0;
    if (starts && prefix == 0) {
        prefix = power_prefix(c, text + k);
        found->is_power = prefix > 0;
    }
    const int device = starts ? dalcs_signal_device_current(text + k) : 0;
    if (device > 0) {
        found->is_current = true;
        found->open = -1;
        found->name = k + 1;
        found->name_end = (int)(strchr(text + k, '[') - text);
        found->end = k + device;
        return true;
    }
    found->open = k + prefix;
    found->name = k + prefix + 1;
    found->is_current = text[k] == 'i';
    int end = found->name;
    /* KiCad's names have a pair of parentheses of their own */
    for (int depth = 1; prefix > 0 && end < c->text.length && depth > 0; end++) {
        depth += (text[end] == '(') - (text[end] == ')');
    }
    found->name_end = end - 1;
    found->end = text[end - 1] == ')' ? end : c->text.length + 1;
    return prefix > 0;
}

/* The same with a function of a complex signal around it, where there are complex signals. */
static bool find_with_function(const struct dalcs_signal_compilation *c, int k,
                               struct found *found) {
    const char *text = c->text.text;
    const bool may = strcmp(c->rules->variable, "frequency") == 0 &&
                     (k == 0 || !dalcs_signal_is_name_byte(text[k - 1]));
    enum dalcs_signal_part part;
    const int n = may ? dalcs_signal_part_function(text + k, &part) : 0;
    if (n == 0 || !find_at(c, k + n, found) || found->end > c->text.length ||
        found->part != DALCS_PART_PLAIN) {
        return find_at(c, k, found);
    }
    const int close = found->end + (int)strspn(text + found->end, " ");
    if (text[close] != ')') {
        return find_at(c, k, found);
    }
    found->begin = k;
    found->end = close + 1;
    found->part = part;
    return true;
}

/* The voltage across an element and the current through it; -1 when an error was reported. */
bool dalcs_signal_formula_has_power(const struct dalcs_builder *builder, int k) {
    const struct dalcs_device *device = &builder->circuit->device[k];
    bool has_two =
        strchr("rlcvidsw", device->letter) != NULL && builder->elements.current_of[k] == k;
    for (int end = 0; end < 2; end++) { /* other parts of the element are behind an inner node */
        const int node = device->node[end];
        has_two =
            has_two && (node == 0 || !dalcs_names_is_inner(builder->elements.node_name[node]));
    }
    return has_two;
}

static int find_power(struct dalcs_signal_compilation *c, const struct found *found, int *current) {
    struct dalcs_builder *builder = c->builder;
    struct dalcs_token name;
    if (!make_token(c, found->name, found->name_end, &name)) {
        return -1;
    }
    const int k = dalcs_builder_find_device(builder, &name);
    if (k < 0) {
        return -1;
    }
    const struct dalcs_device *device = &builder->circuit->device[k];
    if (!dalcs_signal_formula_has_power(builder, k)) {
        report(c, found->begin, found->end - found->begin,
               "write the voltages and currents of its terminals, such as v(a,b)*i(x)",
               "'%s' is not determined by one voltage and one current", name.text);
        return -1;
    }
    *current = dalcs_signal_compilation_find(c, true, &name, NULL);
    return dalcs_signals_measure(builder,
                                 (struct dalcs_signal){.name = device->name,
                                                       .kind = DALCS_SIGNAL_VOLTAGE,
                                                       .device = -1,
                                                       .node = {device->node[0], device->node[1]}});
}

static void mask_signal(struct dalcs_signal_compilation *c, const struct found *found) {
    const char *text = c->text.text;
    const int begin = found->begin;
    const int length = found->end - begin;
    if (found->end > c->text.length) {
        report(c, found->open, 1, NULL, "this parenthesis is never closed");
        return;
    }
    if (dalcs_signal_is_name_byte((char)previous_byte(text, begin)) ||
        previous_byte(text, begin) == ')') {
        report(c, begin, length, NULL, "an operator is missing before '%.*s'", length,
               text + begin);
        return;
    }
    if (c->rules->no_signals != NULL) {
        report(c, begin, length, NULL, "%s", c->rules->no_signals);
        return;
    }
    if (c->n_signals == MOST_SIGNALS) {
        report(c, begin, length, NULL, "more than %d signals in one formula", MOST_SIGNALS);
        return;
    }
    int factor = -1;
    const int signal = found->is_power
                           ? find_power(c, found, &factor)
                           : find_signal(c, found->is_current, found->name, found->name_end);
    if (signal < 0) {
        c->failed = true;
        return;
    }
    mask(c, begin, found->end);
    c->signal[c->n_signals] = signal;
    c->factor[c->n_signals] = factor;
    c->part[c->n_signals++] = found->part;
}

/* mag(v(b)/v(a)): of complex signals the magnitude of a product is the product of theirs, which signals stand for
 * here; that of a sum is not theirs. */
static void take_magnitude(struct dalcs_signal_compilation *c, int k) {
    static const char word[] = "mag";

    enum { LENGTH = sizeof word - 1 };

    const char *text = c->text.text;
    if (strcmp(c->rules->variable, "frequency") != 0 || strncmp(text + k, word, LENGTH) != 0 ||
        text[k + LENGTH + (int)strspn(text + k + LENGTH, " ")] != '(' ||
        (k > 0 && dalcs_signal_is_name_byte(text[k - 1]))) {
        return;
    }
    int depth = 0;
    for (int i = k + LENGTH; i < c->text.length; i++) {
        depth += (text[i] == '(') - (text[i] == ')');
        const bool is_sum = (text[i] == '+' || text[i] == '-') && previous_byte(text, i) == ')';
        if (depth == 0 && text[i] == ')') {
            break;
        }
        if (is_sum) {
            report(c, i, 1, "v(a,b) is v(a)-v(b)", "the magnitude of a sum of complex signals");
            return;
        }
    }
    memcpy(c->masked + k, "abs", LENGTH);
}

void dalcs_signal_compilation_mask(struct dalcs_signal_compilation *c) {
    struct found found;
    for (int k = 0; k < c->text.length && !c->failed; k++) {
        if (find_with_function(c, k, &found)) {
            mask_signal(c, &found);
            k = found.end - 1;
        } else {
            take_magnitude(c, k);
        }
    }
}
