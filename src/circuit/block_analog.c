/* block_analog.c - XSPICE's analog code models of straight lines without memory, as sources. */
#include "block_parts.h"
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

/* ---- With a capacitor -------------------------------------------------------------------------------------------- */

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
        dalcs_block_parse_integrator(c);
    } else if (strcmp(type, "hyst") == 0) {
        dalcs_block_parse_hysteresis(c);
    } else if (strcmp(type, "d_dt") == 0) {
        dalcs_block_parse_derivative(c);
    } else if (strcmp(type, "slew") == 0) {
        dalcs_block_parse_slew(c);
    } else {
        return false;
    }
    return true;
}
