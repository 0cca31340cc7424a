/* block_state.c - XSPICE's analog code models that remember: a switch that lags, an integral, a slope.
 *
 * int is a capacitor that a source charges, between two ideal diodes where it has limits: at a limit it stays, and it
 * leaves as soon as its input turns. hyst is one table of the input, which a switch shifts. d_dt is the current of a
 * capacitor that follows the input. slew is a source whose current is limited, into a capacitor. */
#include "analysis_cards.h"
#include "block_parts.h"
#include "element_cards.h"
#include "model_cards.h"

#include <math.h>

/* 2 hyst while the input comes from above, to a node behind a switch. -1: out of memory. */
static int add_branch(const struct dalcs_block_card *c, double low, double high, double hyst) {
    const struct dalcs_token *name = c->card->token;
    const int level = dalcs_builder_inner_node(c->builder, "level", name);
    const int node = dalcs_builder_inner_node(c->builder, "branch", name);
    struct dalcs_device *s = dalcs_block_add(c, DALCS_SWITCH, "branch", level, node);
    struct dalcs_device *r = dalcs_block_add(c, DALCS_RESISTOR, "branch", node, 0);
    const struct dalcs_switch_model model = {.name = c->block->name->text,
                                             .roff = (double)INFINITY,
                                             .vt = 0.5 * (low + high),
                                             .vh = 0.5 * (high - low) + hyst};
    if (level < 0 || node < 0 || s == NULL || r == NULL ||
        !dalcs_block_add_constant(c, DALCS_VSOURCE, "level", (int[]){level, 0}, 2 * hyst)) {
        return -1;
    }
    dalcs_block_control(s, &c->port[0].end[0], 1);
    s->model = dalcs_switch_add_model(c->builder, &model);
    r->value = 1;
    return s->model >= 0 ? node : -1;
}

void dalcs_block_parse_hysteresis(const struct dalcs_block_card *c) {
    static const char *const names[] = {"in_low",          "in_high",         "hyst",
                                        "out_lower_limit", "out_upper_limit", "input_domain",
                                        "fraction"};
    if (!dalcs_block_check(c, names, 7, 2, "a hysteresis is: Aname in out model")) {
        return;
    }
    const double low = dalcs_block_number(c->block, "in_low", 0);
    const double high = dalcs_block_number(c->block, "in_high", 1);
    const double hyst = dalcs_block_number(c->block, "hyst", 0.1);
    if (!(low < high) || hyst < 0) {
        dalcs_builder_error(c->builder, c->block->type,
                            hyst < 0 ? NULL : "where the output is to jump: SCHMITT, or S with Vh=",
                            hyst < 0 ? "hyst cannot be negative" : "in_low must be below in_high");
        return;
    }
    struct dalcs_piecewise table = dalcs_block_make_table(c, 2);
    struct dalcs_block_end shifted = c->port[0].end[0];
    if (hyst > 0) {
        const int branch = add_branch(c, low, high, hyst);
        const int node = dalcs_builder_inner_node(c->builder, "shifted", c->card->token);
        struct dalcs_device *e = dalcs_block_add(c, DALCS_VCVS, "shifted", node, branch);
        if (branch < 0 || node < 0 || e == NULL) {
            return;
        }
        dalcs_block_control(e, &c->port[0].end[0], 1);
        shifted.node = node;
        shifted.reference = 0;
    }
    if (table.knot != NULL) {
        dalcs_block_set_knot(&table, 0, low + hyst,
                             dalcs_block_number(c->block, "out_lower_limit", 0));
        dalcs_block_set_knot(&table, 1, high + hyst,
                             dalcs_block_number(c->block, "out_upper_limit", 1));
        dalcs_block_add_table(c, &shifted, &table);
    }
}

/* A node of a capacitor, and the source of its voltage that is the output. -1: out of memory. */
static int add_state(const struct dalcs_block_card *c, double farad) {
    const struct dalcs_block_end *out = &c->port[1].end[0];
    const int node = dalcs_builder_inner_node(c->builder, "state", c->card->token);
    struct dalcs_device *e = dalcs_block_add(c, DALCS_VCVS, NULL, out->node, out->reference);
    struct dalcs_device *capacitor = dalcs_block_add(c, DALCS_CAPACITOR, "state", node, 0);
    if (node < 0 || e == NULL || capacitor == NULL) {
        return -1;
    }
    e->node[2] = node;
    e->value = 1;
    capacitor->value = farad;
    return node;
}

/* It goes no further than a limit, which is the forward voltage of a diode to ground. As a source it would be a voltage of
 * the circuit, whatever its distance, and signals are measured by the largest of these; a limit on the other side of 0 is
 * one. */
static bool add_bound(const struct dalcs_block_card *c, int state, bool is_upper, double limit) {
    const char *what = is_upper ? "upper" : "lower";
    const bool is_behind = is_upper ? limit < 0.0 : limit > 0.0;
    if (!isfinite(limit)) {
        return true;
    }
    const int node = is_behind ? dalcs_builder_inner_node(c->builder, what, c->card->token) : 0;
    struct dalcs_device *d =
        dalcs_block_add(c, DALCS_DIODE, what, is_upper ? state : node, is_upper ? node : state);
    if (node < 0 || d == NULL) {
        return false;
    }
    if (is_behind) {
        d->model = dalcs_diode_ideal_model(c->builder);
        return dalcs_block_add_constant(c, DALCS_VSOURCE, is_upper ? "at_upper" : "at_lower",
                                        (int[]){node, 0}, limit);
    }
    struct dalcs_circuit *circuit = c->builder->circuit;
    circuit->models.of_diode[circuit->models.n_diodes] = (struct dalcs_diode_model){
        .name = "limit", .roff = INFINITY, .vfwd = fabs(limit), .vrev = INFINITY};
    d->model = circuit->models.n_diodes++;
    return true;
}

void dalcs_block_parse_integrator(const struct dalcs_block_card *c) {
    static const char *const names[] = {"in_offset",       "gain",        "out_lower_limit",
                                        "out_upper_limit", "limit_range", "out_ic"};
    double low;
    double high;
    if (!dalcs_block_check(c, names, 6, 2, "an integrator is: Aname in out model") ||
        !dalcs_block_read_limits(c, &low, &high)) {
        return;
    }
    const double gain = dalcs_block_number(c->block, "gain", 1);
    const double first = fmin(fmax(dalcs_block_number(c->block, "out_ic", 0), low), high);
    const double offset = dalcs_block_number(c->block, "in_offset", 0);
    if (gain == 0) { /* a controller without that part */
        const struct dalcs_block_end *out = &c->port[1].end[0];
        (void)dalcs_block_add_constant(c, DALCS_VSOURCE, "constant",
                                       (int[]){out->node, out->reference}, first);
        return;
    }
    const double farad = dalcs_charging / fabs(gain);
    const double by = gain > 0 ? dalcs_charging : -dalcs_charging;
    const int state = add_state(c, farad);
    struct dalcs_device *g = state >= 0 ? dalcs_block_add(c, DALCS_VCCS, "charge", 0, state) : NULL;
    if (g == NULL) {
        return;
    }
    dalcs_block_control(g, &c->port[0].end[0], by);
    if (offset != 0 &&
        !dalcs_block_add_constant(c, DALCS_ISOURCE, "constant", (int[]){0, state}, by * offset)) {
        return;
    }
    if (add_bound(c, state, true, high) && add_bound(c, state, false, low)) {
        dalcs_initial_hold(c->builder, c->card->token, (int[]){state, 0}, first);
    }
}

void dalcs_block_parse_slew(const struct dalcs_block_card *c) {
    static const char *const names[] = {"rise_slope", "fall_slope", "range"};
    if (!dalcs_block_check(c, names, 3, 2, "a slew is: Aname in out model")) {
        return;
    }
    const double up = dalcs_block_number(c->block, "rise_slope", 1e9);
    const double down = dalcs_block_number(c->block, "fall_slope", 1e9);
    if (!(up > 0 && down > 0)) {
        dalcs_builder_error(c->builder, c->block->type, NULL, "both slopes are above 0");
        return;
    }
    const double farad = dalcs_charging / fmax(up, down); /* a current of dalcs_charging at most */
    const int state = add_state(c, farad);
    struct dalcs_device *e = state >= 0 ? dalcs_block_add(c, DALCS_VCVS, "follow", state, 0) : NULL;
    if (e == NULL) {
        return;
    }
    dalcs_block_control(e, &c->port[0].end[0], 1);
    const struct dalcs_current_limits limits = {.forward = farad * down, .reverse = farad * up};
    dalcs_current_limit_expand(c->builder, c->card->token, e, &limits);
}

/* gain times the current of a capacitor that a copy of the input charges, as a voltage at a node; -1: out of memory. */
static int add_derivative(const struct dalcs_block_card *c, double gain, int reference) {
    const struct dalcs_token *name = c->card->token;
    const int copy = dalcs_builder_inner_node(c->builder, "copy", name);
    const int node = dalcs_builder_inner_node(c->builder, "rate", name);
    struct dalcs_device *e = dalcs_block_add(c, DALCS_VCVS, "copy", copy, 0);
    struct dalcs_device *capacitor = dalcs_block_add(c, DALCS_CAPACITOR, "copy", copy, 0);
    struct dalcs_device *h = dalcs_block_add(c, DALCS_CCVS, "rate", node, reference);
    if (copy < 0 || node < 0 || e == NULL || capacitor == NULL || h == NULL) {
        return -1;
    }
    dalcs_block_control(e, &c->port[0].end[0], 1);
    capacitor->value = dalcs_charging;
    h->control = (int)(e - c->builder->circuit->device);
    h->value = -gain / dalcs_charging;
    return node;
}

void dalcs_block_parse_derivative(const struct dalcs_block_card *c) {
    static const char *const names[] = {"gain", "out_offset", "out_lower_limit", "out_upper_limit",
                                        "limit_range"};
    double y[2];
    if (!dalcs_block_check(c, names, 5, 2, "a differentiator is: Aname in out model") ||
        !dalcs_block_read_limits(c, &y[0], &y[1])) {
        return;
    }
    const double offset = dalcs_block_number(c->block, "out_offset", 0);
    const int node = add_derivative(c, dalcs_block_number(c->block, "gain", 1), 0);
    const int n = (isfinite(y[0]) ? 1 : 0) + (isfinite(y[1]) ? 1 : 0);
    struct dalcs_piecewise table = dalcs_block_make_table(c, n > 0 ? n : 1);
    if (node < 0 || table.knot == NULL) {
        return;
    }
    table.before = isfinite(y[0]) ? 0 : 1;
    table.after = isfinite(y[1]) ? 0 : 1;
    dalcs_block_set_knot(&table, 0, 0, offset); /* where there is no limit */
    for (int k = 0, at = 0; k < 2; k++) {
        if (isfinite(y[k])) {
            dalcs_block_set_knot(&table, at++, y[k] - offset, y[k]);
        }
    }
    table.zero = offset;
    table.has_zero = true;
    dalcs_block_add_table(c, &(struct dalcs_block_end){.node = node}, &table);
}
