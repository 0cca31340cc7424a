/* card_room.c - how much room cards need: what one of them may become at most. */
#include "card_table.h"
#include "core.h"
#include "element_cards.h"
#include "formula.h"
#include "later.h"
#include "rational.h"

#include <string.h>

size_t dalcs_card_table_count_formulas(const struct dalcs_card *card) {
    size_t n = 0;
    for (int k = 1; k < card->n; k++) {
        n += card->token[k].kind == DALCS_TOKEN_FORMULA ? 1 : 0;
    }
    return n;
}

/* Each becomes a device, and one more measures their current. */
static size_t count_parasitics(const struct dalcs_card *card) {
    size_t n = 0;
    for (int k = 2; k < card->n; k++) {
        n += card->token[k].kind == DALCS_TOKEN_EQUAL &&
             dalcs_parasitic_is_name(card->token[k - 1].text);
    }
    return n > 0 ? n + 1 : 0;
}

/* A flux or a charge that is no straight line: terminal, core, and what finds the argument. */
static size_t count_storage(const struct dalcs_card *card) {
    const bool is_storage = card->letter == 'l' || card->letter == 'c';
    const size_t n_core = dalcs_core_count(card);
    return is_storage ? 3 * dalcs_card_table_count_formulas(card) + (n_core > 0 ? 3 + n_core : 0)
                      : 0;
}

/* I1 a b 50m load */
static bool is_load(const struct dalcs_card *card) {
    bool found = false;
    for (int k = 3; k < card->n && card->letter == 'i'; k++) {
        found = found || (card->token[k].kind == DALCS_TOKEN_WORD &&
                          strcmp(card->token[k].text, "load") == 0);
    }
    return found;
}

static bool is_transfer(const struct dalcs_card *card) {
    bool is = false;
    for (int k = 3; k < card->n; k++) {
        is = is || strcmp(card->token[k].text, "laplace") == 0;
    }
    return is;
}

/* A triac becomes 6 devices, of a code model each port is a gate at most, with an input. */
static void count_block(struct dalcs_card_table *table, const struct dalcs_card *card) {
    if (card->letter == 'a') {
        const size_t n = (size_t)card->n;
        table->n_inner += 6 + 5 * n;
        table->n_stimuli += 2 * n;
        table->n_gates += n;
        table->n_gate_inputs += n;
    }
}

static void count_logic(struct dalcs_card_table *table, const struct dalcs_card *card) {
    if (dalcs_card_is_logic(card)) {
        table->n_gates++;
        table->n_gate_inputs += DALCS_GATE_PINS;
        table->n_stimuli += 10; /* of a modulator with two outputs */
        table->n_inner += DALCS_GATE_DEVICES;
        if (strcmp(card->token[DALCS_LOGIC_MODEL].text, "phasedet") == 0) { /* three gates */
            table->n_gates += 2;
            table->n_gate_inputs += DALCS_GATE_PINS;
            table->n_inner += 2 * DALCS_GATE_DEVICES;
        }
    } else {
        count_block(table, card);
    }
}

static void count_controlled(struct dalcs_card_table *table, const struct dalcs_card *card) {
    const char letter = card->letter;
    if (strchr("efgh", letter) != NULL) {
        const size_t n = dalcs_poly_count(card);
        table->n_inner += n;
        table->n_stimuli += n > 0;
        table->n_inner += is_transfer(card) ? 2 * DALCS_RATIONAL_DEGREE + 1 : 0;
    }
    table->n_inner += letter == 'b' && is_transfer(card) ? 2 * DALCS_RATIONAL_DEGREE + 1 : 0;
}

void dalcs_card_table_count(struct dalcs_card_table *table, const struct dalcs_card *card) {
    struct dalcs_builder *builder = table->builder;
    const char letter = card->letter;
    table->n_stimuli += strchr("vic", letter) != NULL;
    if (letter == 'v') {
        const size_t n_limits = (size_t)dalcs_current_limit_count(card);
        table->n_inner += 2 * n_limits;
        table->n_stimuli += n_limits;
    }
    table->n_inner += count_parasitics(card) + count_storage(card);
    const size_t n_delays = dalcs_delay_count(builder, card);
    table->n_inner += n_delays * DALCS_GATE_DEVICES;
    table->n_stimuli += 2 * n_delays;
    table->n_gates += n_delays;
    table->n_gate_inputs += n_delays;
    table->n_stimuli += dalcs_core_count(card);
    if (letter == 't') {
        table->n_inner += DALCS_LINE_DEVICES;
        table->n_stimuli += 2;
    }
    table->n_inner += is_load(card) ? 2 : 0;
    count_logic(table, card);
    table->n_inner +=
        letter == 'l' && dalcs_dialect_is_told(builder->netlist->dialect, DALCS_DIALECT_LTSPICE);
    count_controlled(table, card);
    table->n_inner += letter == 's' && dalcs_formula_find_control(card) < card->n;
    table->n_switches += letter == 's' || letter == 'w';
    table->n_diodes += letter == 'd' || letter == 'a';
    /* terminal, diode, knee or two diodes more of a bulk; two have lines of their own */
    if (strchr("mzq", letter) != NULL) {
        table->n_inner += 4;
        table->n_scaled += 2;
        table->n_diodes++;
    }
    table->n_scaled += letter == 'd' && (card->n > 4 || card->parallel > 0);
    table->n_scaled += letter == 'a' ? 2 : 0; /* the limits of an integrator */
}

void dalcs_card_table_make_room(struct dalcs_card_table *table) {
    if (table->has_series) {
        table->n_inner += 2 * table->n_switches;
        table->n_stimuli += table->n_switches;
    }
    if (table->has_limits) {
        table->n_inner += 4 * (table->n_diodes + table->n_switches);
        table->n_stimuli += 2 * (table->n_diodes + table->n_switches);
    }
}
