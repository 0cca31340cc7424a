/* transfer.c - LAPLACE: a transfer function of s as states, each a capacitor that a source charges. A factor exp(-s T) is
 * a delay of the input (delay.c).
 *
 *     Ename a b LAPLACE {formula} = {expression of s}
 *     Ename a b control control Laplace=expression of s        Bname a b V=formula Laplace=expression of s
 *
 * Of (b_n s^n + ... + b_0)/(s^n + a_(n-1) s^(n-1) + ... + a_0) the states x_1, ..., x_n go with x_k' = r_k x_(k+1) and
 * x_n' = r_n (u - A_0 x_1 - ... - A_(n-1) x_n), the output is B_n u + (B_0 - B_n A_0) x_1 + ..., where A_k and B_k are
 * a_k and b_k over r_(k+1) ... r_n: the controllable canonical form, each state in its own unit. The rates r are the
 * slopes of the Newton polygon of the denominator, which are the magnitudes of its roots where those lie far apart, and
 * of their size anyhow (Householder 1970, ch. 3): so no A_k is above 1, whatever the units and the spread of poles. */
#include "rational.h"

#include "element_cards.h"
#include "formula_writer.h"
#include "reader.h"

#include <math.h>

struct transfer {
    struct dalcs_builder *builder;
    const struct dalcs_token *name;
    int n;
    double delay;                       /* s, of the input */
    double rate[DALCS_RATIONAL_DEGREE]; /* 1/s, of each state */
    double a[DALCS_RATIONAL_DEGREE + 1], b[DALCS_RATIONAL_DEGREE + 1];
    int input[2];
    int state[DALCS_RATIONAL_DEGREE];
};

/* height[k] of the least concave function that is not below log |a_k|, from the first that is not 0 on. */
static void find_polygon(const struct dalcs_polynomial *p, int first, double *height) {
    for (int k = first; k < p->degree;) {
        int next = k + 1;
        double steepest = -(double)INFINITY;
        for (int i = k + 1; i <= p->degree; i++) {
            const double slope = (log(fabs(p->c[i])) - log(fabs(p->c[k]))) / (double)(i - k);
            if (slope >= steepest) {
                steepest = slope;
                next = i;
            }
        }
        for (int i = k; i <= next; i++) {
            height[i] = log(fabs(p->c[k])) + steepest * (double)(i - k);
        }
        k = next;
    }
}

static void normalize(const struct dalcs_rational *r, struct transfer *t) {
    const struct dalcs_polynomial *below = &r->below;
    double height[DALCS_RATIONAL_DEGREE + 1] = {0};
    int first = 0; /* as many poles are at 0, and go with the slowest other one, or with 1/s */
    while (below->c[first] == 0) {
        first++;
    }
    t->n = below->degree;
    t->delay = r->delay;
    height[t->n] = log(fabs(below->c[t->n]));
    find_polygon(below, first, height);
    for (int k = first - 1; k >= 0; k--) {
        height[k] = height[k + 1] + (first < t->n ? height[first] - height[first + 1] : 0);
    }
    for (int k = 0; k <= t->n; k++) {
        const double unit = below->c[t->n] < 0 ? -exp(-height[k]) : exp(-height[k]);
        t->a[k] = below->c[k] * unit;
        t->b[k] = k <= r->above.degree ? r->above.c[k] * unit : 0;
        if (k > 0) {
            t->rate[k - 1] = exp(height[k - 1] - height[k]);
        }
    }
}

/* constant (v(input[0]) - v(input[1])) + of[k] x_(k+1), as what a source puts out. */
static bool put(struct transfer *t, struct dalcs_device *device, double of_input,
                const double *of_state) {
    struct dalcs_arena *arena = &t->builder->circuit->arena;
    struct dalcs_behaviour *behaviour = dalcs_arena_alloc(arena, 1, sizeof *behaviour);
    struct dalcs_affine_term *term = dalcs_arena_alloc(arena, (size_t)(t->n + 2), sizeof *term);
    if (behaviour == NULL || term == NULL) {
        t->builder->out_of_memory = true;
        return false;
    }
    int n = 0;
    const bool is_turned = t->input[0] > t->input[1];
    for (int k = 0; k < 2; k++) {
        const int node = t->input[is_turned ? 1 - k : k];
        const double sign = (k == 0) != is_turned ? 1 : -1;
        if (node != 0 && of_input != 0 && t->input[0] != t->input[1]) {
            term[n++] = (struct dalcs_affine_term){DALCS_QUANTITY_VOLTAGE, node, sign * of_input};
        }
    }
    for (int k = 0; k < t->n; k++) {
        if (of_state[k] != 0) {
            term[n++] =
                (struct dalcs_affine_term){DALCS_QUANTITY_VOLTAGE, t->state[k], of_state[k]};
        }
    }
    behaviour->output = (struct dalcs_affine){0, n, term};
    device->behaviour = behaviour;
    return true;
}

static bool add_state(struct transfer *t, int k) {
    const char *what = dalcs_builder_hint(t->builder, "x%d", k + 1);
    struct dalcs_device *c =
        what != NULL ? dalcs_builder_add_inner_device(t->builder, DALCS_CAPACITOR, what, t->name)
                     : NULL;
    if (c == NULL) {
        return false;
    }
    c->node[0] = t->state[k];
    c->value = dalcs_charging / t->rate[k];
    return true;
}

static bool add_charging(struct transfer *t, int k) {
    const char *what = dalcs_builder_hint(t->builder, "dx%d", k + 1);
    struct dalcs_device *g =
        what != NULL ? dalcs_builder_add_inner_device(t->builder, DALCS_VCCS, what, t->name) : NULL;
    if (g == NULL) {
        return false;
    }
    g->node[1] = t->state[k];
    double of_state[DALCS_RATIONAL_DEGREE] = {0};
    if (k + 1 < t->n) {
        of_state[k + 1] = dalcs_charging;
        return put(t, g, 0, of_state);
    }
    for (int i = 0; i < t->n; i++) {
        of_state[i] = -dalcs_charging * t->a[i];
    }
    return put(t, g, dalcs_charging, of_state);
}

static bool expand(struct transfer *t, struct dalcs_device *device, double m) {
    for (int k = 0; k < t->n; k++) {
        const char *what = dalcs_builder_hint(t->builder, "x%d", k + 1);
        t->state[k] = what != NULL ? dalcs_builder_inner_node(t->builder, what, t->name) : -1;
        if (t->state[k] < 0) {
            return false;
        }
    }
    double of_state[DALCS_RATIONAL_DEGREE] = {0};
    for (int k = 0; k < t->n; k++) {
        of_state[k] = m * (t->b[k] - t->b[t->n] * t->a[k]);
    }
    if (!put(t, device, m * t->b[t->n], of_state)) {
        return false;
    }
    bool ok = true;
    for (int k = 0; k < t->n && ok; k++) {
        ok = add_state(t, k) && add_charging(t, k);
    }
    return ok;
}

/* The formula of a card that comes next; NULL when an error was reported. */
static const struct dalcs_token *take_formula(struct dalcs_reader *reader, const char *what) {
    (void)dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    if (token == NULL) {
        dalcs_reader_missing(reader, what);
        return NULL;
    }
    if (token->kind == DALCS_TOKEN_BAD) {
        reader->builder->failed = true;
        return NULL;
    }
    if (token->kind != DALCS_TOKEN_FORMULA) {
        dalcs_reader_unexpected(reader);
        return NULL;
    }
    reader->at++;
    return token;
}

/* Those of LTspice's own way with transfer functions, an impulse response: they mean nothing here. */
static bool skip_words(struct dalcs_reader *reader) {
    static const char *const words[] = {"window", "nfft", "mtol", "cache"};
    const struct dalcs_token *name;
    while ((name = dalcs_reader_peek(reader, 0)) != NULL &&
           dalcs_builder_is_one_of(name->text, words, sizeof words / sizeof words[0]) &&
           dalcs_reader_take_parameter(reader) != NULL) {
        dalcs_builder_note(reader->builder, name, NULL,
                           "'%s' has no meaning here and is ignored: the states of a transfer "
                           "function are solved with the circuit",
                           name->text);
        if (!dalcs_reader_skip_value(reader)) {
            return false;
        }
    }
    return true;
}

/* The ratio, and the end of the card; false when an error was reported. */
static bool read_ratio(struct dalcs_reader *reader, struct transfer *t) {
    struct dalcs_rational r;
    const struct dalcs_token *ratio = take_formula(reader, "an expression of s");
    if (ratio == NULL || !skip_words(reader) || !dalcs_reader_end(reader) ||
        !dalcs_rational_make(reader->builder, ratio->formula, &r)) {
        return false;
    }
    if (r.above.degree > r.below.degree) {
        dalcs_builder_error(reader->builder, ratio,
                            "add poles: s/(1 + s*t) for s, with a short time t",
                            "the transfer function is improper: of degree %d over %d, it "
                            "differentiates",
                            r.above.degree, r.below.degree);
        return false;
    }
    normalize(&r, t);
    return true;
}

/* The node of the input, which is a formula, as it was the delay before; -1 after an error. */
static int add_input(const struct transfer *t, const struct dalcs_token *input) {
    struct dalcs_formula_writer w;
    if (t->delay > 0) {
        if (!dalcs_formula_writer_start(&w, t->builder, t->name)) {
            return -1;
        }
        w.n = input->formula->number_of + 1;
        const struct dalcs_formula *seconds = dalcs_formula_number(&w, t->delay);
        input = dalcs_formula_token(
            &w, dalcs_formula_call(&w, "delay", 2,
                                   (const struct dalcs_formula *const[]){input->formula, seconds}));
    }
    return input != NULL ? dalcs_behavioural_add_readout(t->builder, input, "input", t->name) : -1;
}

/* The same of two nodes of a card. */
static int add_input_of_nodes(const struct transfer *t, const struct dalcs_token *node) {
    struct dalcs_formula_writer w;
    if (!dalcs_formula_writer_start(&w, t->builder, t->name)) {
        return -1;
    }
    const struct dalcs_token *input = dalcs_formula_token(
        &w, dalcs_formula_signal(&w, DALCS_FORMULA_VOLTAGE, &node[0], &node[1]));
    return input != NULL ? add_input(t, input) : -1;
}

void dalcs_transfer_parse_behind(struct dalcs_reader *reader, struct dalcs_device *device,
                                 const struct dalcs_token *formula, double m) {
    struct transfer t = {.builder = reader->builder, .name = reader->card->token};
    reader->usage = "a transfer function is: Bname node node V=formula LAPLACE=ratio of "
                    "polynomials in s";
    reader->at++;
    if (read_ratio(reader, &t)) {
        t.input[0] = add_input(&t, formula);
        if (t.input[0] >= 0) {
            (void)expand(&t, device, m);
        }
    }
}

void dalcs_transfer_parse(struct dalcs_reader *reader, struct dalcs_device *device,
                          bool has_control) {
    struct dalcs_builder *builder = reader->builder;
    struct transfer t = {.builder = builder, .name = reader->card->token};
    reader->usage = has_control ? "a transfer function is: LAPLACE=ratio of polynomials in s"
                                : "a transfer function is: LAPLACE {formula} = {ratio of "
                                  "polynomials in s}";
    reader->at++;
    const struct dalcs_token *input = has_control ? NULL : take_formula(reader, "a formula");
    if ((!has_control && input == NULL) || !read_ratio(reader, &t)) {
        return;
    }
    if (has_control && t.delay > 0) {
        t.input[0] = add_input_of_nodes(&t, &reader->card->token[3]);
        device->node[2] = device->node[3] = 0;
    } else if (has_control) {
        t.input[0] = device->node[2];
        t.input[1] = device->node[3];
        device->node[2] = device->node[3] = 0;
    } else {
        t.input[0] = add_input(&t, input);
    }
    const double m = device->kind == DALCS_VCCS ? dalcs_parallel_of(reader->card) : 1;
    if (t.input[0] >= 0) {
        (void)expand(&t, device, m);
    }
}

void dalcs_transfer_expand(struct dalcs_builder *builder, const struct dalcs_token *name,
                           struct dalcs_device *device, const struct dalcs_rational *r,
                           const int *input) {
    struct transfer t = {.builder = builder, .name = name, .input = {input[0], input[1]}};
    normalize(r, &t);
    (void)expand(&t, device, 1);
}
