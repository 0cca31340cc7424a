/* random_osnsp.c - random degenerate one-step problems against enumeration.
 *
 *     random_osnsp [CIRCUITS [FIRST_SEED]]     circuits of each family; prints what it found
 *     random_osnsp FAMILY SEED                 one circuit, with its netlist
 *     random_osnsp FAMILY SEED... [FAMILY SEED...]...
 *
 * Circuits of 2 to 7 nodes and up to 9 diodes go the whole way from text. Every problem that has a
 * solution must be solved with a residual, recomputed here, of at most 2e-13; every other must be
 * refused with a witness that is one. Nothing that has a solution is refuted, and of what has none at least
 * 19 in 20 are. Where values spread over 18 decades or a circuit is not passive,
 * one solvable problem in a hundred may be refused; none may be answered wrongly. The same problem
 * gives the same bits, however small the cache; solved again from another mode, or again and again,
 * it gives the same answer. */
#include "oracle.h"
#include "refute.h"
#include "residual.h"
#include "sketch.h"
#include "text_network.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double residual_limit = 2e-13;

/* Between the answer and the oracle's, where all answers are one; relative to the largest of its
 * unit. */
static const double answer_limit = 1e-9;

/* Between two choices among several answers: the regularisation that makes them is 1e-8 of balanced
 * weights that differ by up to 1e3. */
static const double choice_limit = 1e-4;

enum { REPEATS = 6 };

static const char *const family_name[] = {"integer", "spread", "switches", "controlled"};

struct count {
    int circuits, problems, feasible, infeasible, refuted, unique, singular, missed, failures;
    double worst, worst_repeated, worst_difference;
};

/* One problem of one circuit. */
struct problem {
    const struct sketch *sketch;
    const struct text_network *net;
    int system;
    double sigma;
    double *u;
    bool *closed;
    struct oracle_answer truth;
    struct count *count;
    enum sketch_family family;
    unsigned long seed;
    bool verbose;
};

static bool is_demanding(enum sketch_family family) {
    return family == SKETCH_SPREAD || family == SKETCH_CONTROLLED;
}

static void must_be(bool condition, const char *what) {
    if (!condition) {
        fprintf(stderr, "random_osnsp: %s\n", what);
        abort();
    }
}

static void *zeros(size_t n, size_t size) {
    void *p = calloc(n + 1, size);
    must_be(p != NULL, "out of memory");
    return p;
}

static const struct dalcs_system *system_of(const struct problem *p) {
    return &p->net->network.system[p->system];
}

static void fail(const struct problem *p, const char *what, double number) {
    p->count->failures++;
    printf("FAILED %s %lu: system %d, sigma %g: %s (%.3g)\n", family_name[p->family], p->seed,
           p->system, p->sigma, what, number);
}

/* ---- The engine ---------------------------------------------------------------------------- */

struct engine_answer {
    enum dalcs_status status;
    double *y;
    uint64_t mode;
    double worst;
    bool least_norm;
    bool is_one_case;
    bool is_refuted; /* by weights that farkas.c confirms */
    enum dalcs_witness_kind kind;
    int n_elements, n_weighed;
    const char *element[SKETCH_MAX_ELEMENTS];
    const char *weighed[2 * SKETCH_MAX_ELEMENTS]; /* nodes among them */
};

static void setup(const struct problem *p, struct dalcs_osnsp *osnsp, size_t cache_bytes) {
    struct dalcs_osnsp_options options = usual_osnsp_options();
    options.cache_bytes = cache_bytes;
    must_be(dalcs_osnsp_setup(osnsp, system_of(p), &options) == DALCS_OK, "setup failed");
    for (int d = 0; d < system_of(p)->n_pairs; d++) {
        dalcs_osnsp_command(osnsp, d, p->closed[d]);
    }
}

static struct engine_answer solve_afresh(const struct problem *p, size_t cache_bytes) {
    struct engine_answer a = {.y = zeros((size_t)dalcs_system_n_columns(system_of(p)), 8)};
    struct dalcs_osnsp osnsp;
    setup(p, &osnsp, cache_bytes);
    a.status = dalcs_osnsp_solve(&osnsp, p->sigma, p->u, a.y);
    a.mode = osnsp.n_words > 0 ? osnsp.mode[0] : 0;
    a.worst = osnsp.certificate.worst;
    a.least_norm = osnsp.least_norm;
    must_be(dalcs_osnsp_refute(&osnsp, p->sigma, p->u, &a.is_refuted) == DALCS_OK, "no memory");
    if (a.status == DALCS_INFEASIBLE) {
        a.kind = osnsp.witness.kind;
        a.n_elements = osnsp.witness.n_elements;
        for (int k = 0; k < a.n_elements; k++) {
            a.element[k] = osnsp.witness.element[k];
        }
        a.is_one_case = osnsp.weighed.kind == DALCS_WITNESS_EQUATIONS;
        a.n_weighed = osnsp.weighed.n_elements;
        for (int k = 0; k < a.n_weighed; k++) {
            a.weighed[k] = osnsp.weighed.element[k];
        }
    }
    dalcs_osnsp_finish(&osnsp);
    return a;
}

/* ---- Comparisons --------------------------------------------------------------------------- */

static double difference(const struct dalcs_system *s, const double *a, const double *b) {
    double largest[2] = {0.0, 0.0};
    double apart[2] = {0.0, 0.0};
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        int unit = s->column_is_current[c] ? 1 : 0;
        largest[unit] = fmax(largest[unit], fmax(fabs(a[c]), fabs(b[c])));
        apart[unit] = fmax(apart[unit], fabs(a[c] - b[c]));
    }
    /* Volts and amperes of the families compared here are of one size. */
    double scale = fmax(1.0, fmax(largest[0], largest[1]));
    return fmax(apart[0], apart[1]) / scale;
}

static double reverse_voltage(const struct dalcs_system *s, int pair, const double *u,
                              const double *y) {
    double w = 0.0;
    for (int k = s->C.p[pair]; k < s->C.p[pair + 1]; k++) {
        w += s->C.x[k] * y[s->C.j[k]];
    }
    for (int k = s->F.p[pair]; k < s->F.p[pair + 1]; k++) {
        w += s->F.x[k] * u[s->n_x + s->F.j[k]];
    }
    return w;
}

/* In lambda and w of diodes, relative to the largest of its kind. */
static double difference_of_pairs(const struct dalcs_system *s, const double *u, const double *a,
                                  const double *b) {
    int n_equations = dalcs_system_n_equations(s);
    double largest[2] = {0.0, 0.0};
    double apart[2] = {0.0, 0.0};
    for (int d = 0; d < s->n_pairs; d++) {
        double first[2] = {a[n_equations + d], reverse_voltage(s, d, u, a)};
        double second[2] = {b[n_equations + d], reverse_voltage(s, d, u, b)};
        for (int i = 0; i < 2 && s->pair[d].kind == DALCS_PAIR_DIODE; i++) {
            largest[i] = fmax(largest[i], fmax(fabs(first[i]), fabs(second[i])));
            apart[i] = fmax(apart[i], fabs(first[i] - second[i]));
        }
    }
    double scale = fmax(1.0, fmax(largest[0], largest[1]));
    return fmax(apart[0], apart[1]) / scale;
}

/* The same object again, from the mode it ended in (a recurring mode gets its map), then from all
 * closed and from all open. */
static void check_repeated(const struct problem *p, const struct engine_answer *first) {
    const struct dalcs_system *s = system_of(p);
    struct dalcs_osnsp osnsp;
    double *y = zeros((size_t)dalcs_system_n_columns(s), sizeof(double));
    setup(p, &osnsp, (size_t)1 << 20);
    for (int k = 0; k < REPEATS + 2; k++) {
        for (int d = 0; d < s->n_pairs && k >= REPEATS; d++) {
            if (s->pair[d].kind == DALCS_PAIR_DIODE) {
                dalcs_osnsp_command(&osnsp, d, k == REPEATS);
            }
        }
        if (dalcs_osnsp_solve(&osnsp, p->sigma, p->u, y) != DALCS_OK) {
            fail(p, "not solved again, at repeat", k);
            break;
        }
        double worst = residual_of(s, p->sigma, p->u, p->closed, y);
        p->count->worst_repeated = fmax(p->count->worst_repeated, worst);
        if (!(worst <= residual_limit)) {
            fail(p, "residual of a repeated solve", worst);
        }
        double apart = difference(s, y, first->y);
        if (p->truth.unique && p->family != SKETCH_SPREAD && apart > answer_limit) {
            fail(p, "a repeated solve differs", apart);
        }
        double choice = difference_of_pairs(s, p->u, y, first->y);
        if (s->monotone && p->family != SKETCH_SPREAD && choice > choice_limit) {
            fail(p, "the choice among answers depends on the past", choice);
        }
    }
    dalcs_osnsp_finish(&osnsp);
    free(y);
}

/* ---- Witnesses ----------------------------------------------------------------------------- */

static bool *commands(const struct sketch *sketch, const struct dalcs_system *s) {
    bool *closed = zeros((size_t)s->n_pairs, sizeof(*closed));
    for (int d = 0; d < s->n_pairs; d++) {
        if (s->pair[d].kind == DALCS_PAIR_SWITCH) {
            closed[d] = sketch->element[sketch_find(sketch, s->pair[d].element)].on;
        }
    }
    return closed;
}

/* Does some part of the circuit have no solution? */
static bool is_infeasible(const struct sketch *sketch, double sigma) {
    char text[SKETCH_TEXT_SIZE];
    struct text_network net;
    sketch_write(sketch, text);
    bool infeasible = false;
    if (text_network_build(&net, text) == DALCS_OK) {
        for (int k = 0; k < net.network.n_systems && !infeasible; k++) {
            const struct dalcs_system *s = &net.network.system[k];
            double *u = zeros((size_t)(s->n_x + s->n_inputs), sizeof(*u));
            bool *closed = commands(sketch, s);
            text_network_inputs(&net, k, u);
            struct oracle_answer a = oracle_solve(s, sigma, u, closed);
            infeasible = !a.feasible;
            free(a.y);
            free(u);
            free(closed);
        }
    }
    text_network_finish(&net);
    return infeasible;
}

/* Coils coupled with k = 1 carry each other's current. */
static void keep_ideal_partners(const struct sketch *sketch, bool *keep) {
    for (int k = 0; k < sketch->n; k++) {
        const struct sketch_element *e = &sketch->element[k];
        if (e->kind == 'k' && e->value == 1.0 && (keep[e->node[0]] || keep[e->node[1]])) {
            keep[e->node[0]] = keep[e->node[1]] = true;
        }
    }
}

/* A controlled source reads what is not kept: it is one of some value. */
static bool is_infeasible_alone(const struct sketch *core, double sigma) {
    static const double value = 1.2345;
    struct sketch up = sketch_with_sources(core, value);
    struct sketch down = sketch_with_sources(core, -value);
    return is_infeasible(core, sigma) || is_infeasible(&up, sigma) || is_infeasible(&down, sigma);
}

/* A loop is one when its elements alone, without all others, have no solution; a cutset when all
 * others are wires. At an operating point capacitors are cuts and coils wires whatever the witness
 * says; a wire of 0 ohm is always one. */
static void check_witness(const struct problem *p, const struct engine_answer *a) {
    bool keep[SKETCH_MAX_ELEMENTS] = {false};
    bool is_loop = a->kind == DALCS_WITNESS_LOOP;
    if (a->n_elements == 0) {
        fail(p, "empty witness", 0);
        return;
    }
    if (p->verbose) {
        printf("%s of", a->kind == DALCS_WITNESS_LOOP     ? "loop"
                        : a->kind == DALCS_WITNESS_CUTSET ? "cutset"
                                                          : "mode");
    }
    for (int k = 0; k < a->n_elements; k++) {
        int element = sketch_find(p->sketch, a->element[k]);
        if (element >= 0) { /* otherwise a node whose KCL nothing fits */
            keep[element] = true;
        }
        if (p->verbose) {
            printf(" %s", a->element[k]);
        }
    }
    if (p->verbose) {
        printf("\n");
    }
    if (a->kind == DALCS_WITNESS_MODE) {
        if (system_of(p)->monotone) {
            fail(p, "a witness of modes for a passive circuit", 0);
        }
        return;
    }
    if (a->n_weighed > 0) {
        if (system_of(p)->monotone) {
            fail(p, "weights name no loop and no cutset of a passive circuit", 0);
        }
        if (a->is_one_case && !oracle_contradicts(system_of(p), p->sigma, p->u, p->closed,
                                                  a->weighed, a->n_weighed)) {
            fail(p, "the equations of these do not contradict each other", a->n_weighed);
        }
        return;
    }
    for (int k = 0; k < p->sketch->n; k++) {
        const struct sketch_element *e = &p->sketch->element[k];
        keep[k] = keep[k] || (is_loop && e->kind == 'r' && e->value == 0.0) ||
                  (!is_loop && e->kind == 'c' && p->sigma == 0.0);
    }
    keep_ideal_partners(p->sketch, keep);
    struct sketch core = is_loop ? sketch_without(p->sketch, keep) : sketch_wired(p->sketch, keep);
    core = sketch_unit_values(&core);
    if (!is_infeasible_alone(&core, p->sigma)) {
        fail(p, is_loop ? "the witness is no loop" : "the witness is no cutset", a->n_elements);
    }
}

/* ---- One problem --------------------------------------------------------------------------- */

static void check_feasible(const struct problem *p, const struct engine_answer *a) {
    const struct dalcs_system *s = system_of(p);
    struct count *count = p->count;
    count->feasible++;
    count->singular += a->least_norm ? 1 : 0;
    if (a->status != DALCS_OK && is_demanding(p->family)) {
        count->missed++;
        printf("missed %s %lu: system %d, sigma %g: %s\n", family_name[p->family], p->seed,
               p->system, p->sigma, dalcs_status_text(a->status));
        return;
    }
    if (a->status != DALCS_OK) {
        fail(p, dalcs_status_text(a->status), a->status);
        return;
    }
    double worst = residual_of(s, p->sigma, p->u, p->closed, a->y);
    count->worst = fmax(count->worst, worst);
    if (!(worst <= residual_limit)) {
        fail(p, "residual", worst);
    }
    if (p->truth.unique && p->family != SKETCH_SPREAD) {
        count->unique++;
        double apart = difference(s, a->y, p->truth.y);
        count->worst_difference = fmax(count->worst_difference, apart);
        if (apart > answer_limit) {
            fail(p, "not the oracle's answer", apart);
        }
    }
    check_repeated(p, a);
}

static void check_problem(const struct problem *p) {
    size_t n_columns = (size_t)dalcs_system_n_columns(system_of(p));
    struct engine_answer a = solve_afresh(p, (size_t)1 << 20);
    p->count->problems++;
    if (p->verbose) {
        printf("system %d, sigma %g: %s, %d modes of which one: %s, residual %.3g\n", p->system,
               p->sigma, p->truth.feasible ? "feasible" : "infeasible", p->truth.n_modes,
               dalcs_status_text(a.status),
               residual_of(system_of(p), p->sigma, p->u, p->closed, a.y));
    }
    if (p->truth.feasible) {
        check_feasible(p, &a);
        if (a.is_refuted) {
            fail(p, "refuted, but it has a solution", 0);
        }
    } else {
        p->count->infeasible++;
        p->count->refuted += a.is_refuted ? 1 : 0;
        if (!a.is_refuted && p->verbose) {
            printf("not refuted\n");
        }
        bool refused = a.status == DALCS_INFEASIBLE ||
                       (is_demanding(p->family) && a.status == DALCS_NOT_CONVERGED);
        if (!refused) {
            fail(p, "infeasible, but the engine says otherwise", a.status);
        } else if (a.status == DALCS_INFEASIBLE) {
            check_witness(p, &a);
        }
    }
    struct engine_answer again[2] = {solve_afresh(p, (size_t)1 << 20), solve_afresh(p, 1)};
    for (int k = 0; k < 2; k++) {
        bool same =
            again[k].status == a.status &&
            (a.status != DALCS_OK ||
             (again[k].mode == a.mode && memcmp(again[k].y, a.y, n_columns * sizeof(double)) == 0));
        if (!same) {
            fail(p, k == 0 ? "other bits in a fresh object" : "other bits with a small cache", 0);
        }
        free(again[k].y);
    }
    free(a.y);
}

/* ---- One circuit --------------------------------------------------------------------------- */

static void check_circuit(enum sketch_family family, unsigned long seed, struct count *count,
                          bool verbose) {
    struct sketch sketch = sketch_random(family, (uint64_t)seed * SKETCH_N_FAMILIES + family);
    struct sketch unit = sketch_unit_values(&sketch);
    char text[SKETCH_TEXT_SIZE];
    struct text_network net;
    struct text_network twin;
    sketch_write(&sketch, text);
    if (verbose) {
        printf("%s", text);
    }
    count->circuits++;
    enum dalcs_status status = text_network_build(&net, text);
    sketch_write(&unit, text);
    if (status != DALCS_OK || text_network_build(&twin, text) != DALCS_OK) {
        printf("FAILED %s %lu: %s\n", family_name[family], seed,
               net.diag.n > 0 ? net.diag.item[0].text : dalcs_status_text(status));
        count->failures++;
        text_network_finish(&net);
        return;
    }
    for (int k = 0; k < net.network.n_systems; k++) {
        const struct dalcs_system *s = &net.network.system[k];
        for (int d = 0; d < s->n_pairs; d++) {
            s->pair[d].is_direct =
                true; /* switches are where they are told, whatever their controls say */
        }
        struct problem p = {.sketch = &sketch,
                            .net = &net,
                            .system = k,
                            .u = zeros((size_t)(s->n_x + s->n_inputs), sizeof(double)),
                            .closed = commands(&sketch, s),
                            .count = count,
                            .family = family,
                            .seed = seed,
                            .verbose = verbose};
        text_network_inputs(&net, k, p.u);
        for (int step = 0; step < 2; step++) {
            p.sigma = step;
            p.truth = oracle_solve(family == SKETCH_SPREAD ? &twin.network.system[k] : s, p.sigma,
                                   p.u, p.closed);
            check_problem(&p);
            free(p.truth.y);
        }
        free(p.u);
        free(p.closed);
    }
    text_network_finish(&net);
    text_network_finish(&twin);
}

/* SKETCH_N_FAMILIES: none has this name. */
static int family_of(const char *name) {
    int f = 0;
    while (f < SKETCH_N_FAMILIES && strcmp(name, family_name[f]) != 0) {
        f++;
    }
    return f;
}

/* The circuits of a command line that begins with a family. */
static int check_given(int argc, char **argv) {
    struct count count = {0};
    int family = SKETCH_N_FAMILIES;
    for (int k = 1; k < argc; k++) {
        const int f = family_of(argv[k]);
        if (f < SKETCH_N_FAMILIES) {
            family = f;
        } else {
            check_circuit((enum sketch_family)family, strtoul(argv[k], NULL, 10), &count,
                          argc == 3);
        }
    }
    printf("random_osnsp: %d problems, %d failed\n", count.problems, count.failures + count.missed);
    return count.failures + count.missed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(int argc, char **argv) {
    static const int share[] = {600, 300, 300, 100}; /* circuits of each family */
    if (argc > 2 && family_of(argv[1]) < SKETCH_N_FAMILIES) {
        return check_given(argc, argv);
    }
    int n_circuits = argc > 1 ? atoi(argv[1]) : 0;
    unsigned long first = argc > 2 ? strtoul(argv[2], NULL, 10) : 1;
    int n_failures = 0;
    int n_problems = 0;
    for (int f = 0; f < SKETCH_N_FAMILIES; f++) {
        struct count c = {0};
        int n = n_circuits > 0 ? n_circuits : share[f];
        for (int k = 0; k < n; k++) {
            check_circuit((enum sketch_family)f, first + (unsigned long)k, &c, false);
        }
        if (100 * c.missed > c.feasible) {
            printf("FAILED %s: %d missed are too many\n", family_name[f], c.missed);
            c.failures++;
        }
        if (c.refuted < c.infeasible - c.infeasible / 20) {
            printf("FAILED %s: only %d of %d refuted\n", family_name[f], c.refuted, c.infeasible);
            c.failures++;
        }
        printf("%-10s %5d circuits, %5d problems: %5d feasible (%d of one answer, %d in singular "
               "modes, %d missed), %4d infeasible (%d refuted), %d failed; worst residual %.1e, "
               "repeated %.1e, "
               "off the oracle %.1e\n",
               family_name[f], c.circuits, c.problems, c.feasible, c.unique, c.singular, c.missed,
               c.infeasible, c.refuted, c.failures, c.worst, c.worst_repeated, c.worst_difference);
        fflush(stdout);
        n_failures += c.failures;
        n_problems += c.problems;
    }
    printf("random_osnsp: %d problems, %d failed\n", n_problems, n_failures);
    return n_failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
