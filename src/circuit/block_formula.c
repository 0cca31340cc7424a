/* block_formula.c - XSPICE's code models that are a product, a quotient, a limit or a transfer function of their inputs. */
#include "block_parts.h"
#include "rational.h"

#include <math.h>
#include <string.h>

/* States of s_xfer: each takes two elements, for which a card has room. */
enum { MOST_STATES = 10 };

/* ---- Products -------------------------------------------------------------------------------------------------- */

/* out_gain * what + out_offset, as the voltage of the output. */
static void put_out(const struct dalcs_block_card *c, struct dalcs_formula_writer *w,
                    const struct dalcs_formula *what, const struct dalcs_block_end *out) {
    const double gain = dalcs_block_number(c->block, "out_gain", 1);
    const double offset = dalcs_block_number(c->block, "out_offset", 0);
    if (gain != 1) {
        what = dalcs_formula_operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, gain), what);
    }
    if (offset != 0) {
        what = dalcs_formula_operation(w, DALCS_ADD, what, dalcs_formula_number(w, offset));
    }
    dalcs_block_put_out(c, w, what, out);
}

static void parse_product(const struct dalcs_block_card *c) {
    static const char *const names[] = {"in_offset", "in_gain", "out_gain", "out_offset"};
    static const char usage[] = "a multiplier is: Aname [in in ...] out model";
    struct dalcs_formula_writer w;
    if (!dalcs_block_has_only(c, names, 4) || !dalcs_block_has_ports(c, 2, 0, usage) ||
        !dalcs_block_has_nodes(c, usage) ||
        !dalcs_formula_writer_start(&w, c->builder, c->card->token)) {
        return;
    }
    const struct dalcs_formula *product = NULL;
    for (int k = 0; k < c->port[0].n; k++) {
        const struct dalcs_formula *factor = dalcs_block_line(
            &w, &c->port[0].end[k], dalcs_block_element(c->block, "in_offset", k, 0),
            dalcs_block_element(c->block, "in_gain", k, 1));
        product = k == 0 ? factor : dalcs_formula_operation(&w, DALCS_MULTIPLY, product, factor);
    }
    put_out(c, &w, product, &c->port[1].end[0]);
}

/* What is below stays den_lower_limit away from 0 on its side of it, the positive one at 0, where the card says so:
 * a/b is a/max(|b|, limit) with the sign of b. A divisor that stays away from 0 pays no kink without. */
static const struct dalcs_formula *divide(const struct dalcs_block_card *c,
                                          struct dalcs_formula_writer *w,
                                          const struct dalcs_formula *above,
                                          const struct dalcs_formula *below) {
    const double limit = dalcs_block_number(c->block, "den_lower_limit", 0);
    if (!(limit > 0)) {
        return dalcs_formula_operation(w, DALCS_DIVIDE, above, below);
    }
    const struct dalcs_formula *size = dalcs_formula_call(w, "abs", 1, &below);
    size = dalcs_formula_call(
        w, "max", 2, (const struct dalcs_formula *const[]){size, dalcs_formula_number(w, limit)});
    const struct dalcs_formula *side = dalcs_formula_operation(
        w, DALCS_SUBTRACT,
        dalcs_formula_operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, 2),
                                dalcs_formula_call(w, "ge0", 1, &below)),
        dalcs_formula_number(w, 1));
    return dalcs_formula_operation(w, DALCS_MULTIPLY,
                                   dalcs_formula_operation(w, DALCS_DIVIDE, above, size), side);
}

static void parse_quotient(const struct dalcs_block_card *c) {
    static const char *const names[] = {"num_offset", "num_gain",        "den_offset",
                                        "den_gain",   "den_lower_limit", "den_domain",
                                        "fraction",   "out_gain",        "out_offset"};
    static const char usage[] = "a divider is: Aname above below out model";
    struct dalcs_formula_writer w;
    if (!dalcs_block_has_only(c, names, 9) || !dalcs_block_has_ports(c, 3, 0, usage) ||
        !dalcs_block_has_nodes(c, usage) ||
        !dalcs_formula_writer_start(&w, c->builder, c->card->token)) {
        return;
    }
    const struct dalcs_formula *above =
        dalcs_block_line(&w, &c->port[0].end[0], dalcs_block_number(c->block, "num_offset", 0),
                         dalcs_block_number(c->block, "num_gain", 1));
    const struct dalcs_formula *below =
        dalcs_block_line(&w, &c->port[1].end[0], dalcs_block_number(c->block, "den_offset", 0),
                         dalcs_block_number(c->block, "den_gain", 1));
    put_out(c, &w, divide(c, &w, above, below), &c->port[2].end[0]);
}

/* A line between two signals, the upper one of which counts where they have met. */
static void parse_limits(const struct dalcs_block_card *c) {
    static const char *const names[] = {"in_offset",   "gain",        "upper_delta",
                                        "lower_delta", "limit_range", "fraction"};
    static const char usage[] = "a controlled limiter is: Aname in upper lower out model";
    struct dalcs_formula_writer w;
    if (!dalcs_block_has_only(c, names, 6) || !dalcs_block_has_ports(c, 4, 0, usage) ||
        !dalcs_block_has_nodes(c, usage) ||
        !dalcs_formula_writer_start(&w, c->builder, c->card->token)) {
        return;
    }
    const struct dalcs_formula *value =
        dalcs_block_line(&w, &c->port[0].end[0], dalcs_block_number(c->block, "in_offset", 0),
                         dalcs_block_number(c->block, "gain", 1));
    const struct dalcs_formula *upper = dalcs_block_line(
        &w, &c->port[1].end[0], -dalcs_block_number(c->block, "upper_delta", 0), 1);
    const struct dalcs_formula *lower =
        dalcs_block_line(&w, &c->port[2].end[0], dalcs_block_number(c->block, "lower_delta", 0), 1);
    value = dalcs_formula_call(&w, "max", 2, (const struct dalcs_formula *const[]){value, lower});
    value = dalcs_formula_call(&w, "min", 2, (const struct dalcs_formula *const[]){value, upper});
    dalcs_block_put_out(c, &w, value, &c->port[3].end[0]);
}

/* ---- Transfer functions ---------------------------------------------------------------------------------------- */

/* The list of a parameter, its first number that of the highest power, in rad/s of `unit`. */
static bool read_polynomial(const struct dalcs_block_card *c, const char *name, double unit,
                            double gain, struct dalcs_polynomial *p) {
    const struct dalcs_block_value *value = dalcs_block_find(c->block, name);
    if (value == NULL || value->n < 1 || value->n > MOST_STATES + 1) {
        dalcs_builder_error(c->builder, value != NULL ? value->name : c->block->type, NULL,
                            "%s has from 1 to %d numbers, that of the highest power first", name,
                            MOST_STATES + 1);
        return false;
    }
    *p = (struct dalcs_polynomial){0};
    for (int k = 0; k < value->n; k++) {
        p->c[k] = gain * value->number[value->n - 1 - k] / pow(unit, k);
        p->degree = p->c[k] != 0 ? k : p->degree;
    }
    return true;
}

static bool starts_at_rest(const struct dalcs_block_card *c) {
    const struct dalcs_block_value *first = dalcs_block_find(c->block, "int_ic");
    bool rests = true;
    for (int k = 0; first != NULL && k < first->n; k++) {
        rests = rests && first->number[k] == 0;
    }
    if (!rests) {
        dalcs_builder_error(c->builder, first->name, "write int, whose out_ic counts",
                            "the states of a transfer function begin at rest");
    }
    return rests;
}

/* The input and a constant, as the voltage of a node; -1: out of memory. */
static int add_shifted(const struct dalcs_block_card *c, const struct dalcs_block_end *in,
                       double offset) {
    struct dalcs_builder *builder = c->builder;
    const int sum = dalcs_builder_inner_node(builder, "input", c->card->token);
    const int low = dalcs_builder_inner_node(builder, "offset", c->card->token);
    struct dalcs_device *e =
        dalcs_builder_add_inner_device(builder, DALCS_VCVS, "input", c->card->token);
    struct dalcs_device *v =
        dalcs_builder_add_inner_device(builder, DALCS_VSOURCE, "offset", c->card->token);
    if (sum < 0 || low < 0 || e == NULL || v == NULL) {
        return -1;
    }
    e->node[0] = sum;
    e->node[1] = v->node[0] = low;
    e->node[2] = in->node;
    e->node[3] = in->reference;
    e->value = 1;
    v->stimulus = builder->circuit->n_stimuli++;
    builder->circuit->stimulus[v->stimulus] =
        (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC, .has_dc = true, .dc = offset};
    return sum;
}

static void parse_transfer(const struct dalcs_block_card *c) {
    static const char *const names[] = {"in_offset", "gain",   "num_coeff",        "den_coeff",
                                        "out_ic",    "int_ic", "denormalized_freq"};
    static const char usage[] = "a transfer function is: Aname in out model";
    struct dalcs_rational r = {.delay = 0};
    if (!dalcs_block_has_only(c, names, 7) || !dalcs_block_has_ports(c, 2, 0, usage) ||
        !dalcs_block_has_nodes(c, usage) || !starts_at_rest(c)) {
        return;
    }
    const double unit = dalcs_block_number(c->block, "denormalized_freq", 1);
    const double offset = dalcs_block_number(c->block, "in_offset", 0);
    if (!(unit > 0)) {
        dalcs_builder_error(c->builder, c->block->type, NULL, "denormalized_freq is above 0");
        return;
    }
    if (!read_polynomial(c, "num_coeff", unit, dalcs_block_number(c->block, "gain", 1), &r.above) ||
        !read_polynomial(c, "den_coeff", unit, 1, &r.below)) {
        return;
    }
    if (r.above.degree > r.below.degree || r.below.c[r.below.degree] == 0) {
        dalcs_builder_error(c->builder, c->block->type, "add poles",
                            "the transfer function is improper: of degree %d over %d",
                            r.above.degree, r.below.degree);
        return;
    }
    const struct dalcs_block_end *out = &c->port[1].end[0];
    struct dalcs_device *device = dalcs_block_add(c, DALCS_VCVS, NULL, out->node, out->reference);
    const struct dalcs_block_end *in = &c->port[0].end[0];
    const int shifted = offset != 0 ? add_shifted(c, in, offset) : in->node;
    if (device != NULL && shifted >= 0) {
        dalcs_transfer_expand(c->builder, c->card->token, device, &r,
                              (int[]){shifted, offset != 0 ? 0 : in->reference});
    }
}

bool dalcs_block_parse_formula(struct dalcs_block_card *c) {
    const char *type = c->block->type->text;
    if (strcmp(type, "mult") == 0) {
        parse_product(c);
    } else if (strcmp(type, "divide") == 0) {
        parse_quotient(c);
    } else if (strcmp(type, "climit") == 0) {
        parse_limits(c);
    } else if (strcmp(type, "s_xfer") == 0) {
        parse_transfer(c);
    } else {
        return false;
    }
    return true;
}
