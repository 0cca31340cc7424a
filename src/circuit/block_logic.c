/* block_logic.c - XSPICE's gates, flip-flops and bridges, as gates between 0 V and 1 V.
 *
 * A digital node is a node here, with a source of 0 or 1 V to ground. An adc_bridge is a comparator with a hysteresis
 * from in_low to in_high, a dac_bridge a gate of other levels. What XSPICE calls unknown does not exist: between its
 * thresholds an adc_bridge keeps what it had. */
#include "block.h"
#include "logic_parts.h"

#include <math.h>
#include <string.h>

/* s; of rises, falls and clocks that no model says anything of, as XSPICE has it */
static const double usual_delay = 1e-9;

static struct dalcs_logic_card *start(const struct dalcs_block_card *c, int k, int n_inputs) {
    struct dalcs_token *name = dalcs_arena_alloc(&c->builder->scratch, 1, sizeof *name);
    if (name == NULL) {
        c->builder->out_of_memory = true;
        return NULL;
    }
    *name = *c->card->token;
    if (k > 0) {
        name->text = dalcs_builder_hint(c->builder, "%s[%d]", name->text, k);
    }
    struct dalcs_logic_card *of =
        name->text != NULL ? dalcs_logic_start(c->builder, name, n_inputs) : NULL;
    if (of != NULL) {
        of->is_element = k == 0;
        of->on = of->off = 0.5;
        of->gate->high = 1;
    }
    return of;
}

static void read_input(struct dalcs_logic_card *of, int k, const struct dalcs_block_port *port,
                       int end) {
    const struct dalcs_block_end *e = &port->end[end];
    of->pin[k] = (struct dalcs_logic_pin){.is_wired = !e->is_null,
                                          .is_inverted = e->is_inverted,
                                          .node = e->node,
                                          .reference = e->reference};
}

/* Drives a port with q, or with its complement. Delays are those of the output. */
static void drive(struct dalcs_logic_card *of, const struct dalcs_block_end *end, bool is_inverted,
                  double rise, double fall) {
    is_inverted = is_inverted != end->is_inverted;
    of->node[is_inverted] = end->node;
    of->common = end->reference;
    of->gate->delay[0] = is_inverted ? rise : fall;
    of->gate->delay[1] = is_inverted ? fall : rise;
}

static bool is_delay_wrong(const struct dalcs_block_card *c) {
    for (int k = 0; k < c->block->n; k++) {
        const struct dalcs_block_value *value = &c->block->value[k];
        const size_t length = strlen(value->name->text);
        const bool is_delay = length > 6 && strcmp(value->name->text + length - 6, "_delay") == 0;
        if (is_delay && value->n > 0 && !(value->number[0] >= 0)) {
            dalcs_builder_error(c->builder, value->name, NULL, "'%s' cannot be negative",
                                value->name->text);
            return true;
        }
    }
    return false;
}

static bool are_levels_wrong(const struct dalcs_block_card *c, const char *low, double usual_low,
                             const char *high, double usual_high, bool may_be_equal) {
    const double a = dalcs_block_number(c->block, low, usual_low);
    const double b = dalcs_block_number(c->block, high, usual_high);
    if (a < b || (may_be_equal && a == b)) {
        return false;
    }
    dalcs_builder_error(c->builder, c->block->type, NULL, "%s must be below %s", low, high);
    return true;
}

/* ---- Gates ------------------------------------------------------------------------------------------------- */

static void parse_gate(struct dalcs_block_card *c, enum dalcs_logic_kind kind, bool is_inverted) {
    static const char *const names[] = {"rise_delay", "fall_delay", "input_load", "family",
                                        "inertial_delay"};
    const bool has_inputs = c->n_ports > 1;
    if (!dalcs_block_has_only(c, names, 5) || is_delay_wrong(c) ||
        !dalcs_block_has_ports(c, 2, 0, "a gate is: Aname [in in ...] out model")) {
        return;
    }
    struct dalcs_logic_card *of = start(c, 0, has_inputs ? c->port[0].n : 0);
    if (of == NULL) {
        return;
    }
    of->gate->kind = kind;
    for (int k = 0; k < of->gate->n_inputs; k++) {
        read_input(of, k, &c->port[0], k);
    }
    drive(of, &c->port[c->n_ports - 1].end[0], is_inverted,
          dalcs_block_number(c->block, "rise_delay", usual_delay),
          dalcs_block_number(c->block, "fall_delay", usual_delay));
    dalcs_logic_add(c->builder, of);
}

/* d_pullup, d_pulldown: an OR of nothing, and its complement. */
static void parse_level(struct dalcs_block_card *c, bool is_high) {
    static const char *const names[] = {"load"};
    if (!dalcs_block_has_only(c, names, 1) ||
        !dalcs_block_has_ports(c, 1, 0, "a level is: Aname out model")) {
        return;
    }
    struct dalcs_logic_card *of = start(c, 0, 0);
    if (of != NULL) {
        of->gate->kind = DALCS_GATE_OR;
        drive(of, &c->port[0].end[0], is_high, 0, 0);
        dalcs_logic_add(c->builder, of);
    }
}

/* ---- Flip-flops ---------------------------------------------------------------------------------------------- */

/* data, or two of them, clock, set, reset, q, complement: one of the two outputs */
static void add_flip_flop(struct dalcs_block_card *c, enum dalcs_logic_kind kind, int k) {
    const int n_data = c->n_ports - 5;
    const struct dalcs_block_end *out = &c->port[n_data + 3 + k].end[0];
    if (out->is_null) {
        return;
    }
    const bool is_first = k == 0 || c->port[n_data + 3].end[0].is_null;
    struct dalcs_logic_card *of = start(c, is_first ? 0 : 1, DALCS_GATE_CLEAR + 1);
    if (of == NULL) {
        return;
    }
    of->gate->kind = kind;
    for (int port = 0; port < n_data; port++) {
        read_input(of, port, &c->port[port], 0);
    }
    for (int port = 0; port < 3; port++) {
        read_input(of, DALCS_GATE_CLOCK + port, &c->port[n_data + port], 0);
    }
    of->gate->initial = dalcs_block_number(c->block, "ic", 0) == 1;
    drive(of, out, k == 1, dalcs_block_number(c->block, "rise_delay", usual_delay),
          dalcs_block_number(c->block, "fall_delay", usual_delay));
    struct dalcs_logic_gate *g = of->gate;
    const char *delay = kind == DALCS_GATE_DATA_LATCH ? "data_delay"
                        : kind == DALCS_GATE_SR_LATCH ? "sr_delay"
                                                      : "clk_delay";
    const double clock = dalcs_block_number(c->block, delay, usual_delay);
    g->forced_delay[0] = g->delay[0] + dalcs_block_number(c->block, "reset_delay", usual_delay);
    g->forced_delay[1] = g->delay[1] + dalcs_block_number(c->block, "set_delay", usual_delay);
    g->delay[0] += clock;
    g->delay[1] += clock;
    dalcs_logic_add(c->builder, of);
}

static void parse_flip_flop(struct dalcs_block_card *c, enum dalcs_logic_kind kind) {
    static const char *const names[] = {
        "clk_delay",   "set_delay",  "reset_delay", "ic",       "rise_delay",  "fall_delay",
        "data_load",   "clk_load",   "set_load",    "jk_load",  "t_load",      "sr_load",
        "enable_load", "reset_load", "data_delay",  "sr_delay", "enable_delay"};
    const size_t n_names = sizeof names / sizeof names[0];
    const bool is_latch = kind == DALCS_GATE_DATA_LATCH || kind == DALCS_GATE_SR_LATCH;
    const int n_data =
        kind == DALCS_GATE_JK || kind == DALCS_GATE_SR || kind == DALCS_GATE_SR_LATCH ? 2 : 1;
    struct dalcs_block_port *port = c->port;
    if (c->n_ports == n_data + 4) { /* the complement may be left out */
        port[c->n_ports].end = dalcs_arena_alloc(&c->builder->scratch, 1, sizeof *port->end);
        if (port[c->n_ports].end == NULL) {
            c->builder->out_of_memory = true;
            return;
        }
        port[c->n_ports].n = 1;
        port[c->n_ports++].end[0].is_null = true;
    }
    if (!dalcs_block_has_only(c, names, is_latch ? n_names : n_names - 3) || is_delay_wrong(c) ||
        !dalcs_block_has_ports(
            c, n_data + 5, 0,
            n_data == 1 ? "a flip-flop is: Aname data clock set reset q complement model"
                        : "a flip-flop is: Aname j k clock set reset q complement model")) {
        return;
    }
    const char *delay = kind == DALCS_GATE_DATA_LATCH ? "data_delay" : "sr_delay";
    const double data = dalcs_block_number(c->block, delay, usual_delay);
    if (is_latch && dalcs_block_number(c->block, "enable_delay", data) != data) {
        dalcs_builder_warn(c->builder, dalcs_block_find(c->block, "enable_delay")->name,
                           "give both the same value", "%s is the delay of the enable, too", delay);
    }
    add_flip_flop(c, kind, 0);
    add_flip_flop(c, kind, 1);
}

static void parse_divider(struct dalcs_block_card *c) {
    static const char *const names[] = {"div_factor", "high_cycles", "i_count",
                                        "rise_delay", "fall_delay",  "freq_in_load"};
    const double cycles = dalcs_block_number(c->block, "div_factor", 2);
    const double n_high = dalcs_block_number(c->block, "high_cycles", 1);
    const double first = dalcs_block_number(c->block, "i_count", 0);
    if (!dalcs_block_has_only(c, names, 6) || is_delay_wrong(c) ||
        !dalcs_block_has_ports(c, 2, 0, "a divider is: Aname in out model")) {
        return;
    }
    if (!(cycles >= 2 && cycles < 1e9) || floor(cycles) != cycles || !(n_high >= 1) ||
        !(n_high < cycles) || floor(n_high) != n_high || first != 0) {
        dalcs_builder_error(c->builder, c->block->type, NULL,
                            "d_fdiv has whole numbers 0 < high_cycles < div_factor, and i_count 0");
        return;
    }
    struct dalcs_logic_card *of = start(c, 0, 2);
    if (of != NULL) {
        of->gate->kind = DALCS_GATE_COUNTER;
        of->gate->cycles = (int)cycles;
        of->gate->n_high = (int)n_high;
        read_input(of, 0, &c->port[0], 0);
        drive(of, &c->port[1].end[0], false,
              dalcs_block_number(c->block, "rise_delay", usual_delay),
              dalcs_block_number(c->block, "fall_delay", usual_delay));
        dalcs_logic_add(c->builder, of);
    }
}

/* ---- Bridges -------------------------------------------------------------------------------------------------- */

static void parse_bridge(struct dalcs_block_card *c, bool is_adc) {
    static const char *const adc_names[] = {"in_low", "in_high", "rise_delay", "fall_delay"};
    static const char *const dac_names[] = {"out_low",    "out_high", "out_undef",
                                            "input_load", "t_rise",   "t_fall"};
    if (!(is_adc ? dalcs_block_has_only(c, adc_names, 4) : dalcs_block_has_only(c, dac_names, 6)) ||
        is_delay_wrong(c) ||
        !dalcs_block_has_ports(c, 2, 0, "a bridge is: Aname [in ...] [out ...] model") ||
        (is_adc ? are_levels_wrong(c, "in_low", 0.1, "in_high", 0.9, true)
                : are_levels_wrong(c, "out_low", 0, "out_high", 1, false))) {
        return;
    }
    if (c->port[0].n != c->port[1].n) {
        dalcs_builder_error(c->builder, c->card->token, NULL, "'%s' has %d inputs and %d outputs",
                            c->card->token->text, c->port[0].n, c->port[1].n);
        return;
    }
    for (int k = 0; k < c->port[0].n; k++) {
        struct dalcs_logic_card *of = start(c, k, 1);
        if (of == NULL) {
            return;
        }
        of->gate->kind = DALCS_GATE_BUFFER;
        read_input(of, 0, &c->port[0], k);
        if (is_adc) {
            of->on = dalcs_block_number(c->block, "in_high", 0.9);
            of->off = dalcs_block_number(c->block, "in_low", 0.1);
        } else {
            of->gate->low = dalcs_block_number(c->block, "out_low", 0);
            of->gate->high = dalcs_block_number(c->block, "out_high", 1);
            of->gate->rise = dalcs_block_number(c->block, "t_rise", usual_delay);
            of->gate->fall = dalcs_block_number(c->block, "t_fall", usual_delay);
        }
        drive(of, &c->port[1].end[k], false,
              is_adc ? dalcs_block_number(c->block, "rise_delay", usual_delay) : 0,
              is_adc ? dalcs_block_number(c->block, "fall_delay", usual_delay) : 0);
        dalcs_logic_add(c->builder, of);
    }
}

bool dalcs_block_parse_logic(struct dalcs_block_card *c) {
    static const struct {
        const char *type;
        enum dalcs_logic_kind kind;
        bool is_inverted;
    } gates[] = {{"d_and", DALCS_GATE_AND, false},
                 {"d_nand", DALCS_GATE_AND, true},
                 {"d_or", DALCS_GATE_OR, false},
                 {"d_nor", DALCS_GATE_OR, true},
                 {"d_xor", DALCS_GATE_XOR, false},
                 {"d_xnor", DALCS_GATE_XOR, true},
                 {"d_buffer", DALCS_GATE_BUFFER, false},
                 {"d_inverter", DALCS_GATE_BUFFER, true},
                 {"d_dff", DALCS_GATE_FLIP_FLOP, false},
                 {"d_jkff", DALCS_GATE_JK, false},
                 {"d_tff", DALCS_GATE_TOGGLE, false},
                 {"d_srff", DALCS_GATE_SR, false},
                 {"d_dlatch", DALCS_GATE_DATA_LATCH, false},
                 {"d_srlatch", DALCS_GATE_SR_LATCH, false}};

    const char *type = c->block->type->text;
    for (size_t k = 0; k < sizeof gates / sizeof gates[0]; k++) {
        if (strcmp(type, gates[k].type) == 0) {
            if (gates[k].kind >= DALCS_GATE_FLIP_FLOP) {
                parse_flip_flop(c, gates[k].kind);
            } else {
                parse_gate(c, gates[k].kind, gates[k].is_inverted);
            }
            return true;
        }
    }
    if (strcmp(type, "d_fdiv") == 0) {
        parse_divider(c);
    } else if (strcmp(type, "oneshot") == 0) {
        dalcs_block_parse_one_shot(c);
    } else if (strcmp(type, "adc_bridge") == 0 || strcmp(type, "dac_bridge") == 0) {
        parse_bridge(c, type[0] == 'a');
    } else if (strcmp(type, "d_pullup") == 0 || strcmp(type, "d_pulldown") == 0) {
        parse_level(c, strcmp(type, "d_pullup") == 0);
    } else {
        return false;
    }
    return true;
}
