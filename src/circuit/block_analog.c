/* block_analog.c - XSPICE's analog code models of straight lines, as sources, capacitors and ideal diodes.
 *
 * int is a capacitor that a source charges, between two ideal diodes where it has limits: at a limit it stays, and it
 * leaves as soon as its input turns. hyst is one table of the input, which a switch shifts. d_dt is the current of a
 * capacitor that follows the input. slew is a source whose current is limited, into a capacitor. */
#include "analysis_cards.h"
#include "block_parts.h"
#include "element_cards.h"
#include "model_cards.h"

#include <math.h>
#include <string.h>

/* ---- Without memory ------------------------------------------------------------------------------------------- */

/* gain and summer: sources in series, and one of what does not depend on the inputs. */
static bool add_sum(const struct dalcs_block_card *c, const double *gain, double constant) {
    const struct dalcs_block_end *out = &c->port[1].end[0];
    int from = out->node;
    for (int k = 0; k < c->port[0].n; k++) {
        const bool is_last = k == c->port[0].n - 1 && constant == 0;
        const char *what = dalcs_builder_hint(c->builder, "term%d", k + 1);
        const int to =
            is_last ? out->reference : dalcs_builder_inner_node(c->builder, what, c->card->token);
        struct dalcs_device *e = dalcs_block_add(c, DALCS_VCVS, k == 0 ? NULL : what, from, to);
        if (e == NULL || to < 0) {
            return false;
        }
        dalcs_block_control(e, &c->port[0].end[k], gain[k]);
        from = to;
    }
    return constant == 0 || dalcs_block_add_constant(c, DALCS_VSOURCE, "constant",
                                                     (int[]){from, out->reference}, constant);
}

static void parse_sum(const struct dalcs_block_card *c, bool is_gain) {
    static const char *const names[] = {"in_offset", "in_gain", "out_gain", "out_offset"};
    static const char *const gain_names[] = {"in_offset", "gain", "out_offset"};
    if (!(is_gain
              ? dalcs_block_check(c, gain_names, 3, 2, "a gain is: Aname in out model")
              : dalcs_block_check(c, names, 4, 2, "a summer is: Aname [in in ...] out model"))) {
        return;
    }
    double *gain = dalcs_arena_alloc(&c->builder->scratch, (size_t)c->port[0].n, sizeof *gain);
    if (gain == NULL) {
        c->builder->out_of_memory = true;
        return;
    }
    double constant = dalcs_block_number(c->block, "out_offset", 0);
    for (int k = 0; k < c->port[0].n; k++) {
        gain[k] = is_gain ? dalcs_block_number(c->block, "gain", 1)
                          : dalcs_block_element(c->block, "in_gain", k, 1) *
                                dalcs_block_number(c->block, "out_gain", 1);
        constant += gain[k] * dalcs_block_element(c->block, "in_offset", k, 0);
    }
    (void)add_sum(c, gain, constant);
}

static void parse_limit(const struct dalcs_block_card *c) {
    static const char *const names[] = {"in_offset",       "gain",        "out_lower_limit",
                                        "out_upper_limit", "limit_range", "fraction"};
    double y[2];
    if (!dalcs_block_check(c, names, 6, 2, "a limit is: Aname in out model") ||
        !dalcs_block_read_limits(c, &y[0], &y[1])) {
        return;
    }
    const double gain = dalcs_block_number(c->block, "gain", 1);
    const double offset = dalcs_block_number(c->block, "in_offset", 0);
    if (gain == 0 || (!isfinite(y[0]) && !isfinite(y[1]))) {
        dalcs_builder_error(c->builder, c->block->type, "write gain",
                            "a limit has a gain other than 0, and a limit");
        return;
    }
    const int n = (isfinite(y[0]) ? 1 : 0) + (isfinite(y[1]) ? 1 : 0);
    struct dalcs_piecewise table = dalcs_block_make_table(c, n);
    if (table.knot == NULL) {
        return;
    }
    table.before = isfinite(gain > 0 ? y[0] : y[1]) ? 0 : gain;
    table.after = isfinite(gain > 0 ? y[1] : y[0]) ? 0 : gain;
    for (int k = 0, at = 0; k < 2; k++) {
        const double limit = y[gain > 0 ? k : 1 - k];
        if (isfinite(limit)) {
            dalcs_block_set_knot(&table, at++, limit / gain - offset, limit);
        }
    }
    table.zero = gain * offset;
    table.has_zero = true;
    dalcs_block_add_table(c, &c->port[0].end[0], &table);
}

static void parse_pwl(const struct dalcs_block_card *c) {
    static const char *const names[] = {"x_array", "y_array", "input_domain", "fraction", "limit"};
    struct dalcs_piecewise table;
    if (!dalcs_block_check(c, names, 5, 2, "a table is: Aname in out model") ||
        !dalcs_block_read_table(c, "x_array", "y_array", &table)) {
        return;
    }
    if (dalcs_block_number(c->block, "limit", 0) != 0) {
        table.before = table.after = 0;
    }
    dalcs_block_add_table(c, &c->port[0].end[0], &table);
}

static void parse_switch(const struct dalcs_block_card *c) {
    static const char *const names[] = {"cntl_off", "cntl_on", "log", "r_off", "r_on"};
    if (!dalcs_block_check(c, names, 5, 2, "a switch is: Aname control %gd(node node) model")) {
        return;
    }
    const double off = dalcs_block_number(c->block, "cntl_off", 0);
    const double on = dalcs_block_number(c->block, "cntl_on", 1);
    struct dalcs_switch_model model = {.name = c->block->name->text,
                                       .ron = dalcs_block_number(c->block, "r_on", 1),
                                       .roff = dalcs_block_number(c->block, "r_off", 1e12),
                                       .vt = 0.5 * (off + on),
                                       .is_inverted = on < off};
    if (!(model.ron >= 0 && model.roff > model.ron)) {
        dalcs_builder_error(c->builder, c->block->type, NULL,
                            "r_on cannot be negative, and r_off is above it");
        return;
    }
    model.vt = model.is_inverted ? -model.vt : model.vt;
    dalcs_builder_warn(c->builder, c->card->token, NULL,
                       "'%s' changes over at once, half way between cntl_off and cntl_on",
                       c->card->token->text);
    struct dalcs_device *s =
        dalcs_block_add(c, DALCS_SWITCH, NULL, c->port[1].end[0].node, c->port[1].end[0].reference);
    if (s != NULL) {
        s->node[2] = c->port[0].end[0].node;
        s->node[3] = c->port[0].end[0].reference;
        s->model = dalcs_switch_add_model(c->builder, &model);
    }
}

/* ---- With a switch ---------------------------------------------------------------------------------------------- */

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

/* Two branches of one shape. The output is continuous where the input passes from one to the other, for both are at the
 * same limit there. */
static void parse_hysteresis(const struct dalcs_block_card *c) {
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

/* ---- With a capacitor -------------------------------------------------------------------------------------------- */

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
    circuit->diode_model[circuit->n_diode_models] = (struct dalcs_diode_model){
        .name = "limit", .roff = INFINITY, .vfwd = fabs(limit), .vrev = INFINITY};
    d->model = circuit->n_diode_models++;
    return true;
}

static void parse_integrator(const struct dalcs_block_card *c) {
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
    if (gain == 0) {
        dalcs_builder_error(c->builder, c->block->type, NULL, "the gain of an integrator is not 0");
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
        dalcs_initial_hold(c->builder, c->card->token, state, first);
    }
}

static void parse_slew(const struct dalcs_block_card *c) {
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

static void parse_derivative(const struct dalcs_block_card *c) {
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

bool dalcs_block_parse_analog(struct dalcs_block_card *c) {
    const char *type = c->block->type->text;
    if (strcmp(type, "gain") == 0 || strcmp(type, "summer") == 0) {
        parse_sum(c, type[0] == 'g');
    } else if (strcmp(type, "limit") == 0) {
        parse_limit(c);
    } else if (strcmp(type, "pwl") == 0) {
        parse_pwl(c);
    } else if (strcmp(type, "aswitch") == 0 || strcmp(type, "pswitch") == 0) {
        parse_switch(c);
    } else if (strcmp(type, "int") == 0) {
        parse_integrator(c);
    } else if (strcmp(type, "hyst") == 0) {
        parse_hysteresis(c);
    } else if (strcmp(type, "d_dt") == 0) {
        parse_derivative(c);
    } else if (strcmp(type, "slew") == 0) {
        parse_slew(c);
    } else {
        return false;
    }
    return true;
}
