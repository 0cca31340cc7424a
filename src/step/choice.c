/* choice.c - stages, tolerance and maps of a part, as measured: doc/integrator.md says why. */
#include "choice.h"

#include "magnitudes.h"

#include <math.h>

/* What a small part aims at where less is asked for. A run takes hardly longer for it, and an event is where it should
 * be to 1e-11 of the run. choose_stages() says it in words, too. */
static const double aimed = 1e-9;

/* Unknowns up to which a step is a dense map, over the limit of the OSNSP's maps: factors are cheaper
 * from about three dozen on, but a map is as exact as doubles can be, which tight tolerances need where
 * conductances spread by so much: random converters lose digits on factors from 1e7 on. With few stages
 * steps are short, and there are enough of them for each map. */
static const double maps_when_tight = 1.5, maps_when_not = 0.5;

enum { MANY_STAGES = 7 };

/* A part of so many unknowns, over the same limit, gains from nine stages. */
static const double very_small = 0.25;

/* Those of a row are seen, over `time` where it is one of rates. */
static void see_conductances(const struct dalcs_system *s, const struct dalcs_csr *m, int row,
                             bool is_current, double time, struct dalcs_conductances *seen) {
    for (int k = m->p[row]; k < m->p[row + 1]; k++) {
        if (s->column_is_current[m->j[k]] != is_current && m->x[k] != 0.0) {
            double size = fabs(m->x[k]) / time;
            double g = is_current ? size : 1.0 / size;
            seen->least = fmin(seen->least, g);
            seen->most = fmax(seen->most, g);
        }
    }
}

/* Of a row of KCL: its own voltage stands with the sum of all others. */
static double joint_conductance(const struct dalcs_system *s, int row) {
    double most = 0.0;
    for (int k = s->A.p[row]; k < s->A.p[row + 1]; k++) {
        most = s->column_is_current[s->A.j[k]] ? most : fmax(most, fabs(s->A.x[k]));
    }
    return most;
}

struct dalcs_conductances dalcs_conductances_find(const struct dalcs_system *s, double stop) {
    struct dalcs_conductances g = {.least = INFINITY};
    int n_equations = dalcs_system_n_equations(s);
    for (int r = 0; r < n_equations; r++) {
        see_conductances(s, &s->A, r, s->row_is_current[r], 1.0, &g);
        g.joint = s->row_is_current[r] ? fmax(g.joint, joint_conductance(s, r)) : g.joint;
        if (r < s->n_x) {
            see_conductances(s, &s->P, r, s->row_is_current[r], stop, &g);
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        see_conductances(s, &s->C, d, !s->column_is_current[n_equations + d], 1.0, &g);
    }
    return g;
}

static bool has_source(const struct dalcs_component *c, enum dalcs_stimulus_kind kind) {
    bool found = false;
    for (int k = 1; k < c->system->n_inputs && !found; k++) {
        found = c->circuit->stimulus[c->system->stimulus[k]].kind == kind;
    }
    return found;
}

/* A formula of sources that swings, or steps. */
static bool has_formula(const struct dalcs_component *c, bool swings) {
    bool found = false;
    for (int k = 1; k < c->system->n_inputs && !found; k++) {
        const struct dalcs_stimulus *s = &c->circuit->stimulus[c->system->stimulus[k]];
        found = s->kind == DALCS_STIMULUS_FORMULA && (dalcs_stimulus_n_terms(s) > 0) == swings;
    }
    return found;
}

static bool is_pulsed(const struct dalcs_component *c) {
    return has_source(c, DALCS_STIMULUS_PULSE) || has_formula(c, false);
}

static bool is_swinging(const struct dalcs_component *c) {
    return has_source(c, DALCS_STIMULUS_SIN) || has_source(c, DALCS_STIMULUS_TONES) ||
           has_formula(c, true);
}

/* Whoever chooses the stages or the step gets what is asked for. */
static double choose_tolerance(const struct dalcs_radau_options *o, int n, int dense_limit) {
    bool is_free = o->stages == 0 && !(o->fixed_step > 0.0);
    return n <= dense_limit && is_free ? fmin(o->tolerance, aimed) : o->tolerance;
}

/* Fewer modes than unknowns, as a line has that ends at a diode: one of n unknowns moves at n rates at most, and each is
 * followed for many steps on the factors of few modes. So stages cost no more than in proportion, and steps of nine are
 * longer by more than that. */
static bool has_few_modes(const struct dalcs_component *c, int n) {
    return c->system->monotone && ldexp(1.0, c->system->n_pairs) < n;
}

/* Small parts pay little for more stages, mostly as dense maps, and save steps and maps. Nine are
 * too many where pulses end steps before errors do, where a map is expensive, and where controlled sources may
 * make the index 3: second derivatives show ten times the rounding of seven. Large parts pay for each
 * stage with a factorisation in some new modes, and save steps where a sine sets their length. */
static int choose_stages(double tolerance, bool does_better, const struct dalcs_component *c, int n,
                         int dense_limit, const char **because) {
    if (n > dense_limit && has_few_modes(c, n)) {
        *because = "large, few modes";
        return 9;
    }
    if (n > dense_limit) {
        bool few = is_pulsed(c) || !is_swinging(c);
        *because = few ? "large" : "large, sine";
        return few ? 5 : 7;
    }
    bool many = tolerance < dalcs_nothing && n <= (int)(very_small * dense_limit) &&
                c->system->monotone && !is_pulsed(c);
    static const char *const why[2][2] = {{"small", "very small"},
                                          {"small, held to 1e-9", "very small, held to 1e-9"}};
    *because = why[does_better][many];
    return many ? 9 : 7;
}

static int choose_map_limit(double tolerance, const struct dalcs_conductances *g, int stages,
                            int dense_limit) {
    bool is_worth_it = g->least < dalcs_nothing * g->most || stages < MANY_STAGES;
    bool more = tolerance < dalcs_nothing && is_worth_it;
    return (int)((more ? maps_when_tight : maps_when_not) * dense_limit);
}

struct dalcs_choice dalcs_choice_make(const struct dalcs_radau_options *o,
                                      const struct dalcs_component *c,
                                      const struct dalcs_conductances *g, int dense_limit) {
    int n = dalcs_system_n_columns(c->system);
    struct dalcs_choice choice = {.tolerance = choose_tolerance(o, n, dense_limit),
                                  .stages = o->stages};
    if (choice.stages == 0) {
        choice.stages = choose_stages(choice.tolerance, choice.tolerance < o->tolerance, c, n,
                                      dense_limit, &choice.because);
    }
    choice.map_limit = choose_map_limit(choice.tolerance, g, choice.stages, dense_limit);
    return choice;
}
