/* block_pulse.c - XSPICE's oneshot, a monostable: a pulse behind a clock, as long as a table of its control says. */
#include "block_parts.h"
#include "element_cards.h"
#include "logic_parts.h"

#include <math.h>

static void read_input(struct dalcs_logic_card *of, int k, const struct dalcs_block_end *e) {
    of->pin[k] = (struct dalcs_logic_pin){.is_wired = !e->is_null,
                                          .is_inverted = e->is_inverted,
                                          .node = e->node,
                                          .reference = e->reference};
}

/* q is high from a clock on; its output is that, delayed. What the pulse lasts besides its edges is a table of the
 * control, read just before the clock. */
static struct dalcs_logic_card *read_one_shot(const struct dalcs_block_card *c,
                                              const struct dalcs_piecewise *length) {
    static const double usual = 1e-9; /* s, as XSPICE has it */
    struct dalcs_logic_card *of =
        dalcs_logic_start(c->builder, c->card->token, DALCS_GATE_CLEAR + 1);
    if (of == NULL) {
        return NULL;
    }
    struct dalcs_logic_gate *g = of->gate;
    const struct dalcs_block_end *out = &c->port[3].end[0];
    g->kind = DALCS_GATE_MONOSTABLE;
    read_input(of, DALCS_GATE_CLOCK, &c->port[0].end[0]);
    read_input(of, DALCS_GATE_CLEAR, &c->port[2].end[0]);
    of->pin[DALCS_GATE_CLOCK].is_inverted = dalcs_block_number(c->block, "pos_edge_trig", 1) == 0;
    of->on = of->off = dalcs_block_number(c->block, "clk_trig", 0.5);
    of->node[0] = out->node;
    of->common = out->reference;
    g->delay[1] = dalcs_block_number(c->block, "rise_delay", usual);
    g->delay[0] = dalcs_block_number(c->block, "fall_delay", usual);
    g->low = dalcs_block_number(c->block, "out_low", 0);
    g->high = dalcs_block_number(c->block, "out_high", 1);
    g->rise = dalcs_block_number(c->block, "rise_time", usual);
    g->fall = dalcs_block_number(c->block, "fall_time", usual);
    g->pulse.lead = g->delay[1] + g->rise;
    g->pulse.recovery = g->delay[0] + g->fall;
    g->pulse.is_retriggered = dalcs_block_number(c->block, "retrig", 0) != 0;
    g->pulse.length = fmax(0, dalcs_piecewise_at(length, 0, 0));
    return of;
}

static bool is_wrong(const struct dalcs_block_card *c, const char *usage) {
    static const char *const times[] = {"rise_time", "fall_time", "rise_delay", "fall_delay"};
    for (int k = 0; k < 4; k++) {
        const struct dalcs_block_value *value = dalcs_block_find(c->block, times[k]);
        if (value != NULL && value->n > 0 && !(value->number[0] >= 0)) {
            dalcs_builder_error(c->builder, value->name, NULL, "'%s' cannot be negative", times[k]);
            return true;
        }
    }
    const bool has_nodes = !c->port[0].end[0].is_null && !c->port[3].end[0].is_null;
    const bool has_levels =
        dalcs_block_number(c->block, "out_low", 0) < dalcs_block_number(c->block, "out_high", 1);
    if (!has_nodes || !has_levels) {
        dalcs_builder_error(c->builder, c->card->token, usage, "%s",
                            has_nodes ? "out_low must be below out_high"
                                      : "the clock and the output must be nodes");
    }
    return !has_nodes || !has_levels;
}

void dalcs_block_parse_one_shot(const struct dalcs_block_card *c) {
    static const char *const names[] = {"cntl_array", "pw_array",   "clk_trig",  "pos_edge_trig",
                                        "out_low",    "out_high",   "rise_time", "fall_time",
                                        "rise_delay", "fall_delay", "retrig"};
    static const char usage[] = "a monostable is: Aname clock control clear out model, control and "
                                "clear may be null";
    struct dalcs_piecewise length;
    if (!dalcs_block_has_only(c, names, 11) || !dalcs_block_has_ports(c, 4, 0, usage) ||
        !dalcs_block_read_table(c, "cntl_array", "pw_array", &length) || is_wrong(c, usage)) {
        return;
    }
    struct dalcs_logic_card *of = read_one_shot(c, &length);
    const struct dalcs_block_end *control = &c->port[1].end[0];
    if (of != NULL && !control->is_null && control->node != control->reference) {
        const int node = dalcs_builder_inner_node(c->builder, "length", c->card->token);
        struct dalcs_device *e = dalcs_block_add(c, DALCS_VCVS, "length", node, 0);
        if (node < 0 || e == NULL) {
            return;
        }
        dalcs_block_control(e, control, 1);
        dalcs_behavioural_add_table(c->builder, e, &length);
        of->sampled.node = node;
    }
    if (of != NULL) {
        dalcs_logic_add(c->builder, of);
    }
}
