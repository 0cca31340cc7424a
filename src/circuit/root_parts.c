/* root_parts.c - a root of what is 0 on one side, as sqrt(max(x, 0)): a pair, and a root with the sign of its argument.
 *
 * Where x reaches 0 from above the root y does so with x = y^2, and x touches 0 without a sign: max(x, 0) as a pair has its
 * guard there. Below 0 the root is flat, and x has the sign. With
 *
 *     y = pwrs(m, p),     0 <= y _|_ m - x >= 0
 *
 * each side has the guard that crosses 0: y while m = x, and -x while y = 0, where y = 0 means m = 0. The root with a sign
 * rises everywhere, so that Newton's method meets it in one place (dalcs/smooth_roots.c). m is the voltage of a node whose
 * source has the equation y - v(root) = 0. */
#include "behaviour.h"

#include <math.h>

/* The exponent of a root, if it is one of this argument's sign: 1 of max(x, 0), -1 of min(x, 0). Else 0. */
static double exponent_of(enum dalcs_smooth_kind kind, const struct dalcs_form **argument,
                          int sign) {
    const bool is_power =
        kind == DALCS_SMOOTH_SIGNED_POWER ||
        (sign > 0 && (kind == DALCS_SMOOTH_POWER || kind == DALCS_SMOOTH_MAGNITUDE_POWER));
    const double exponent = kind == DALCS_SMOOTH_SQRT && sign > 0 ? 0.5
                            : kind == DALCS_SMOOTH_CBRT           ? 1.0 / 3.0
                            : is_power && dalcs_form_is_number(argument[1])
                                ? argument[1]->affine.constant
                                : 0.0;
    return exponent > 0.0 && exponent < 1.0 ? exponent : 0.0;
}

static bool is_zero(const struct dalcs_knot *knot) {
    return knot->left == 0.0 && knot->value == 0.0 && knot->right == 0.0;
}

/* Is it 0 up to its first knot (is_last: from its last one on), and of one sign beyond? Returns that sign, or 0. */
static int side_of(const struct dalcs_piecewise *f, bool is_last) {
    const int end = is_last ? f->n - 1 : 0;
    const double flat = is_last ? f->after : f->before;
    const double other = is_last ? -f->before : f->after;
    const double slope = dalcs_piecewise_slope(f, is_last ? end : 1) * (is_last ? -1.0 : 1.0);
    const int sign = slope > 0.0 ? 1 : -1;
    bool is_one = flat == 0.0 && slope != 0.0 && is_zero(&f->knot[end]) && sign * other >= 0.0;
    for (int k = 0; k < f->n && is_one; k++) {
        const struct dalcs_knot *knot = &f->knot[k];
        is_one = k == end || (sign * knot->left > 0.0 && sign * knot->right > 0.0);
    }
    return is_one ? sign : 0;
}

/* A form that is max(h, 0) or min(h, 0), as sign is 1 or -1, of one quantity that circuits decide; 0: another one. */
static int sign_of(const struct dalcs_form *form) {
    const bool is_of_one = form->n == 1 && dalcs_affine_is_constant(&form->affine) &&
                           form->affine.constant == 0.0 &&
                           !dalcs_affine_is_time(&form->part[0].direction);
    const int sign = is_of_one ? side_of(&form->part[0].f, false) : 0;
    return sign == 0 && is_of_one ? side_of(&form->part[0].f, true) : sign;
}

/* h: the piece beside the flat one goes on beyond the knot between the two. */
static const struct dalcs_form *extend(struct dalcs_compiler *c, const struct dalcs_form *form) {
    const struct dalcs_piecewise *f = &form->part[0].f;
    const bool is_last = side_of(f, false) == 0;
    const int end = is_last ? f->n - 1 : 0;
    const double slope = dalcs_piecewise_slope(f, is_last ? end : 1);
    if (f->n == 1) {
        const struct dalcs_affine number = dalcs_affine_constant(-slope * f->knot[0].at);
        const struct dalcs_affine line =
            dalcs_affine_add(c, &number, slope, &form->part[0].direction);
        return dalcs_form_affine(c, &line);
    }
    struct dalcs_form_part *part = dalcs_arena_alloc(c->arena, 1, sizeof *part);
    if (!dalcs_form_check(c, part != NULL)) {
        return NULL;
    }
    *part = form->part[0];
    part->f.n--;
    part->f.knot += is_last ? 0 : 1;
    part->f.before = is_last ? f->before : slope;
    part->f.after = is_last ? slope : f->after;
    part->f.has_zero = false;
    return dalcs_form_keep(c, (struct dalcs_form){.n = 1, .part = part});
}

/* A node at h; -1 after an error. */
static int node_of_argument(struct dalcs_compiler *c, const struct dalcs_formula *f, int *source) {
    struct dalcs_compiler inner;
    if (!dalcs_compiler_start_inner(c, &inner, c->n_forms)) {
        return -1;
    }
    const struct dalcs_form *form = dalcs_compile(&inner, f);
    form = form != NULL && !inner.failed ? extend(&inner, form) : NULL;
    struct dalcs_behaviour *behaviour = form != NULL ? dalcs_behaviour_make(&inner, form) : NULL;
    dalcs_compiler_finish_inner(c, &inner);
    const int node = behaviour != NULL && !c->failed ? dalcs_compiler_new_node(c, "argument") : -1;
    if (node < 0) {
        return -1;
    }
    behaviour->is_part = true;
    *source = c->builder->circuit->n_devices;
    return dalcs_compiler_add_source(c, "argument", node, behaviour);
}

/* sum of factor[k] times what kind[k] and index[k] are, in the circuit's arena. */
static struct dalcs_affine sum_of(struct dalcs_compiler *c, int n,
                                  const struct dalcs_affine_term *what) {
    struct dalcs_affine sum = dalcs_affine_constant(0.0);
    struct dalcs_affine_term *term =
        dalcs_arena_alloc(&c->builder->circuit->arena, (size_t)n, sizeof *term);
    if (dalcs_form_check(c, term != NULL)) {
        for (int k = 0; k < n; k++) {
            term[k] = what[k];
        }
        sum.term = term;
        sum.n = n;
    }
    return sum;
}

static const struct dalcs_behaviour *keep(struct dalcs_compiler *c, struct dalcs_behaviour b,
                                          struct dalcs_affine w) {
    struct dalcs_arena *arena = &c->builder->circuit->arena;
    struct dalcs_behaviour *kept = dalcs_arena_alloc(arena, 1, sizeof *kept);
    struct dalcs_affine *row = dalcs_arena_alloc(arena, 1, sizeof *row);
    if (!dalcs_form_check(c, kept != NULL && row != NULL)) {
        return NULL;
    }
    *row = w;
    *kept = b;
    kept->n_pairs = 1;
    kept->w = row;
    kept->is_part = true;
    return kept;
}

/* The source of m, as the engine has it, and as the formula is written: max(x, 0), which is 0 <= m _|_ m - x >= 0. */
static const struct dalcs_behaviour *make(struct dalcs_compiler *c, const int *node, int sign) {
    const double s = sign;
    const struct dalcs_affine_term m = {DALCS_QUANTITY_VOLTAGE, node[0], 1.0};
    const struct dalcs_affine_term root = {DALCS_QUANTITY_VOLTAGE, node[1], -1.0};
    const struct dalcs_affine_term lambda = {DALCS_QUANTITY_PAIR, 0, s};
    const struct dalcs_affine_term size = {DALCS_QUANTITY_PAIR, 0, 1.0};
    const struct dalcs_affine_term ahead = {DALCS_QUANTITY_VOLTAGE, node[0], s};
    const struct dalcs_affine_term x = {DALCS_QUANTITY_VOLTAGE, node[2], -s};
    struct dalcs_behaviour written = {.output =
                                          sum_of(c, 1, (const struct dalcs_affine_term[]){lambda})};
    struct dalcs_behaviour b = {
        .output = sum_of(c, 3, (const struct dalcs_affine_term[]){m, root, lambda}),
        .is_implicit = true};
    b.written = keep(c, written, sum_of(c, 2, (const struct dalcs_affine_term[]){x, size}));
    return keep(c, b, sum_of(c, 2, (const struct dalcs_affine_term[]){ahead, x}));
}

bool dalcs_root_is_one_sided(const struct dalcs_compiler *c, enum dalcs_smooth_kind kind,
                             const struct dalcs_form **argument) {
    const int sign = c->storage.is_it ? 0 : sign_of(argument[0]);
    return sign != 0 && exponent_of(kind, argument, sign) > 0.0;
}

bool dalcs_root_begin(struct dalcs_compiler *c, const struct dalcs_formula *f,
                      const struct dalcs_form **argument, struct dalcs_smooth *smooth,
                      struct dalcs_root *root) {
    root->sign = sign_of(argument[0]);
    root->node[0] = dalcs_compiler_new_node(c, "held");
    root->node[2] = node_of_argument(c, f->argument[0], &smooth->source[0]);
    smooth->node[0] = root->node[0];
    smooth->node[1] = smooth->source[1] = -1;
    if (smooth->kind != DALCS_SMOOTH_CBRT) {
        smooth->number[1] = exponent_of(smooth->kind, argument, root->sign);
        smooth->kind = DALCS_SMOOTH_SIGNED_POWER;
        smooth->n = 2;
    }
    c->failed = c->failed || root->node[0] < 0 || root->node[2] < 0;
    return !c->failed;
}

bool dalcs_root_finish(struct dalcs_compiler *c, struct dalcs_root *root, int node) {
    root->node[1] = node;
    const struct dalcs_behaviour *behaviour = make(c, root->node, root->sign);
    return !c->failed && dalcs_compiler_add_source(c, "held", root->node[0], behaviour) >= 0;
}
