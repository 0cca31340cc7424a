/* signal_columns.c - formulas and powers among the signals: columns that are computed from others. */
#include "element_cards.h"
#include "reader.h"
#include "result_cards.h"
#include "signals.h"

#include <string.h>

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
    if (builder->results.is_print) {
        dalcs_signals_add_column(builder, name);
    }
    if (dalcs_names_find(&builder->signals.names, name) >= 0) {
        return;
    }
    if (dalcs_names_add(&builder->signals.names, name, 0) != DALCS_OK ||
        dalcs_grow(&builder->signals.computed, &builder->signals.computed_capacity,
                   builder->signals.n_computed + 1,
                   sizeof *builder->signals.computed) != DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    builder->signals.computed[builder->signals.n_computed++] =
        (struct dalcs_computed){name, (int)builder->signals.n, *formula};
}

/* w(r1) or p(r1), of an element that has one. */
void dalcs_signals_add_power(struct dalcs_builder *builder, char letter, int device) {
    struct dalcs_signal_formula formula;
    const char *name = dalcs_arena_printf(&builder->circuit->arena, "%c(%s)", letter,
                                          builder->circuit->device[device].name);
    builder->out_of_memory = builder->out_of_memory || name == NULL;
    if (name != NULL && dalcs_computed_power(builder, device, &formula)) {
        add_computed(builder, name, &formula);
    }
}

void dalcs_signals_note_power(struct dalcs_builder *builder, const struct dalcs_token *token,
                              const char *argument) {
    if (!builder->noted.power) {
        dalcs_builder_note(
            builder, token, "{v(a,b)*i(x)} is that of two terminals",
            "a power that is not one voltage times one current is not recorded: %s%s is left out",
            token->text, argument);
        builder->noted.power = true;
    }
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
    const bool is_known = dalcs_names_find(&builder->signals.names, name) >= 0;
    const int node = is_known ? 0 : dalcs_behavioural_add_readout(builder, token, "readout", named);
    if (node >= 0) {
        dalcs_signals_add(
            builder, name,
            (struct dalcs_signal){.kind = DALCS_SIGNAL_VOLTAGE, .node = {node, 0}, .device = -1});
    }
}

/* Of each element that has one: ngspice's allp, PSpice's w(alias(*)). */
void dalcs_signals_add_powers(struct dalcs_builder *builder, char letter) {
    for (int k = 0; k < builder->circuit->n_devices; k++) {
        if (!dalcs_names_is_inner(builder->circuit->device[k].name) &&
            dalcs_signal_formula_has_power(builder, k)) {
            dalcs_signals_add_power(builder, letter, k);
        }
    }
}

/* {v(a)*2}, par('...'), name=par('...'), and what follows a signal in v(a)-v(b). */
bool dalcs_signals_is_formula(const struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *next = dalcs_reader_peek(reader, 1);
    const char first = token->text[0]; /* KiCad's nodes may begin with a slash */
    const bool is_operator = first != '\0' && strchr("+-*/", first) != NULL &&
                             dalcs_names_find(&reader->builder->elements.nodes, token->text) < 0;
    if (next != NULL && next->kind == DALCS_TOKEN_EQUAL && dalcs_reader_peek(reader, 2) != NULL) {
        token = dalcs_reader_peek(reader, 2); /* name=formula */
        next = dalcs_reader_peek(reader, 3);
    }
    const bool is_par =
        strcmp(token->text, "par") == 0 && next != NULL && next->kind == DALCS_TOKEN_OPEN;
    return is_operator || is_par || token->kind == DALCS_TOKEN_EXPRESSION ||
           token->kind == DALCS_TOKEN_FORMULA;
}

/* {formula}, par('formula') and name=par('formula'); false: another form. */
bool dalcs_signals_read_formula(struct dalcs_reader *reader) {
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

/* v(alias(*)), i(alias(*)), w(alias(*)) on PSpice's .probe: all of them; d(...) and noise(...): nothing that there is
 * here. False: another form. */
bool dalcs_signals_read_all_of(struct dalcs_reader *reader) {
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
        dalcs_signals_add_voltages(builder);
    } else if (letter == 'i') {
        dalcs_signals_add_currents(builder);
    } else if (letter == 'w') {
        dalcs_signals_add_powers(builder, letter);
    }
    return true;
}

/* w(r1) or p(r1) of an element with two terminals, whose power is that of its own voltage; false: of another. */
bool dalcs_signals_read_power(struct dalcs_reader *reader) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *letter = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *name = dalcs_reader_peek(reader, 2);
    const struct dalcs_token *close = dalcs_reader_peek(reader, 3);
    if (letter->text[0] == 'n' || name == NULL || close == NULL ||
        close->kind != DALCS_TOKEN_CLOSE) {
        return false;
    }
    const int device = dalcs_names_find(&builder->elements.devices, name->text);
    if (device < 0 || !dalcs_signal_formula_has_power(builder, device)) {
        return false;
    }
    dalcs_signals_add_power(builder, letter->text[0], device);
    reader->at += 4;
    return true;
}
