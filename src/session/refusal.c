/* refusal.c - why there is no solution, as a sentence: of a loop (refusal_loop.c), a part that is fed
 * (refusal_part.c), modes that do not fit, a jump that nothing approaches. */
#include "refusal_words.h"

#include <math.h>
#include <string.h>

/* 0 where the value is rounding of what it consists of. */
static double without_rounding(const struct dalcs_stimulus *s, double t, double value) {
    struct dalcs_stimulus_term terms[DALCS_STIMULUS_MOST_TERMS];
    struct dalcs_stimulus_piece piece = {.term = terms};
    dalcs_stimulus_piece_at(s, t, &piece);
    double size = fabs(piece.level) + fabs(piece.slope) * t; /* t has rounding, too */
    for (int k = 0; k < piece.n_terms; k++) {
        size += fabs(piece.term[k].cosine) + fabs(piece.term[k].sine);
    }
    return fabs(value) > 1e-9 * size ? value : 0.0;
}

/* ---- Circuits that are not passive --------------------------------------------------------- */

/* Without diodes a circuit has one mode, and what is named is the equation that fits worst. */
static bool has_modes(const struct dalcs_refusal *r) {
    bool has = false;
    for (int i = 0; i < r->circuit->n_devices && !has; i++) {
        enum dalcs_device_kind kind = r->circuit->device[i].kind;
        const struct dalcs_behaviour *behaviour = r->circuit->device[i].behaviour;
        has = r->is_named[i] && (kind == DALCS_DIODE || kind == DALCS_SWITCH ||
                                 (behaviour != NULL && behaviour->n_pairs > 0));
    }
    return has;
}

/* The device of this name, -1 where it is a node's. */
static int device_of(const struct dalcs_circuit *c, const char *name) {
    int device = -1;
    for (int i = 0; i < c->n_devices && device < 0; i++) {
        device = strcmp(c->device[i].name, name) == 0 ? i : -1;
    }
    return device;
}

/* What keeps the problem from being monotone: what reads a quantity on which it acts. */
static void list_active(const struct dalcs_refusal *r, struct dalcs_refusal_list *active) {
    for (int i = 0; i < r->circuit->n_devices; i++) {
        if (!r->circuit->device[i].is_transformer && /* all its windings together take nothing */
            dalcs_osnsp_acts_on_what_it_reads(r->osnsp, r->circuit->device[i].name)) {
            dalcs_refusal_put(active, r->circuit->device[i].name);
        }
    }
}

static const char *explain_modes(const struct dalcs_refusal *r) {
    struct dalcs_refusal_list named = {.s = r->s};
    struct dalcs_refusal_list active = {.s = r->s};
    for (size_t k = 0; k < r->n_elements; k++) {
        dalcs_refusal_put(&named, device_of(r->circuit, r->element[k]) >= 0
                                      ? r->element[k]
                                      : dalcs_arena_printf(&r->s->arena, "node %s", r->element[k]));
    }
    list_active(r, &active);
    int first = r->n_elements > 0 ? device_of(r->circuit, r->element[0]) : -1;
    bool is_formula = first >= 0 && r->circuit->device[first].behaviour != NULL;
    const char *format = !r->is_certain && !has_modes(r)
                             ? "the best answer that was tried has its largest residual at %s"
                         : !r->is_certain
                             ? "no combination of conducting and blocking that was tried fits %s"
                         : !has_modes(r) ? "the equations contradict each other, most at %s"
                         : named.n == 1 && is_formula ? "%s fits no piece of its formula"
                         : named.n == 1               ? "%s fits neither conducting nor blocking"
                                        : "no combination of conducting and blocking fits %s";
    const char *what =
        dalcs_arena_printf(&r->s->arena, format, dalcs_refusal_joined(&named, false));
    if (active.n == 0 || what == NULL) {
        return what;
    }
    return dalcs_arena_printf(&r->s->arena, "%s; %s %s the circuit from being passive", what,
                              dalcs_refusal_joined(&active, false),
                              dalcs_refusal_plural(&active, "keeps", "keep"));
}

/* ---- Jumps --------------------------------------------------------------------------------- */

static const char *explain_derivative(const struct dalcs_refusal *r) {
    struct dalcs_refusal_list named = {.s = r->s};
    for (size_t k = 0; k < r->n_elements; k++) {
        dalcs_refusal_put(&named, r->element[k]);
    }
    return dalcs_arena_printf(
        &r->s->arena,
        !r->is_certain ? "%s would have to jump farther in each shorter step that was tried"
                       : "%s would have to jump by the derivative of an impulse, which no "
                         "vanishing step approaches; start from values that need none",
        dalcs_refusal_joined(&named, false));
}

/* ---- All together -------------------------------------------------------------------------- */

static const char *plain_list(const struct dalcs_refusal *r, const char *why) {
    struct dalcs_refusal_list l = {.s = r->s};
    for (size_t k = 0; k < r->n_elements; k++) {
        dalcs_refusal_put(&l, r->element[k]);
    }
    return dalcs_arena_printf(&r->s->arena, "%s: %s", dalcs_refusal_joined(&l, false), why);
}

/* Room for what a loop or a part may name. */
static const char **room_for_names(const struct dalcs_refusal *r, size_t n) {
    return dalcs_arena_alloc(&r->s->arena, n, sizeof(const char *));
}

static void order_as_netlist(struct dalcs_refusal *r) {
    const char **name = room_for_names(r, r->n_elements);
    size_t n = 0;
    for (int i = 0; i < r->circuit->n_devices && name != NULL; i++) {
        if (r->is_named[i] && n < r->n_elements) {
            name[n++] = r->circuit->device[i].name;
        }
    }
    r->element = n == r->n_elements ? name : r->element;
}

static bool is_among(const char *const *list, size_t n, const char *name) {
    size_t k = 0;
    while (k < n && strcmp(list[k], name) != 0) {
        k++;
    }
    return k < n;
}

/* Of a circuit that is not passive, where no loop and no part is found that explains it: the elements whose equations
 * have verified weights, or the pairs that each case of the proof is about, in the order of the netlist. Returns whether
 * there are any. */
static bool say_equations(struct dalcs_refusal *r) {
    const struct dalcs_witness *w = &r->osnsp->weighed;
    const char **name = room_for_names(r, (size_t)w->n_elements);
    size_t n = 0;
    if (w->n_elements == 0 || name == NULL) {
        return false;
    }
    for (int i = -1; i < r->circuit->n_devices; i++) {
        for (int k = 0; k < w->n_elements; k++) {
            bool is_device = dalcs_place_of(r->circuit, w->element[k]) != NULL;
            bool is_next = i < 0 ? !is_device /* a node, whose KCL cannot be met */
                                 : strcmp(w->element[k], r->circuit->device[i].name) == 0;
            if (is_next && !is_among(name, n, w->element[k])) { /* parts may share a name */
                name[n++] = w->element[k];
            }
        }
    }
    r->kind = w->kind;
    r->element = name;
    r->n_elements = n;
    if (w->kind == DALCS_WITNESS_MODE) {
        r->because = explain_modes(r);
        return true;
    }
    r->because = plain_list(
        r, n == 1 ? "its equation cannot be met, whatever the other unknowns are"
                  : "their equations contradict each other, whatever the other unknowns are");
    return true;
}

static void say_loop(struct dalcs_refusal *r) {
    size_t most = 2 * (r->n_elements + (size_t)r->circuit->n_initial_conditions) + 1;
    struct dalcs_loop_arc *arc = dalcs_arena_alloc(&r->s->arena, most, sizeof(*arc));
    const char **name = room_for_names(r, most);
    int n = 0;
    if (arc == NULL || name == NULL || dalcs_driven_loop_find(r, arc, &n) != DALCS_OK) {
        return;
    }
    if (n == 0 && say_equations(r)) {
        return;
    }
    if (n == 0) {
        order_as_netlist(r);
        r->because = dalcs_refusal_of_coupled(r);
        return;
    }
    for (int k = 0; k < n; k++) {
        name[k] = arc[k].device < 0 ? ".ic" : r->circuit->device[arc[k].device].name;
    }
    r->element = name;
    r->n_elements = (size_t)n;
    r->because = dalcs_refusal_of_loop(r, arc, n);
}

static void say_part(struct dalcs_refusal *r) {
    struct dalcs_fed_part part;
    if (dalcs_fed_part_find(r, &part) != DALCS_OK || !part.found) {
        (void)say_equations(r);
        return;
    }
    const char **name = room_for_names(r, (size_t)(part.n_sources + part.n_blockers));
    if (name == NULL) {
        return;
    }
    r->element = name;
    r->n_elements = 0;
    for (int i = 0; i < r->circuit->n_devices; i++) {
        if (part.into[i] != 0.0) {
            name[r->n_elements++] = r->circuit->device[i].name;
        }
    }
    for (int i = 0; i < r->circuit->n_devices; i++) {
        if (part.blocks[i]) {
            name[r->n_elements++] = r->circuit->device[i].name;
        }
    }
    r->because = dalcs_refusal_of_part(r, &part);
}

/* Of a system file, which has no elements but names. */
static const char *explain_system(const struct dalcs_refusal *r) {
    static const char *const why[] = {
        [DALCS_WITNESS_LOOP] = "no multipliers and unknowns of these names fulfil the equations",
        [DALCS_WITNESS_CUTSET] = "no values of these names fulfil the equations",
        [DALCS_WITNESS_MODE] = "no combination of w = 0 and lambda = 0 fits",
        [DALCS_WITNESS_EQUATIONS] = "their equations contradict each other",
    };
    return r->kind == DALCS_WITNESS_DERIVATIVE ? explain_derivative(r)
                                               : plain_list(r, why[r->kind]);
}

void dalcs_refusal_explain(struct dalcs_refusal *r) {
    const struct dalcs_circuit *c = r->circuit;
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (r->is_from && d->stimulus >= 0) {
            const struct dalcs_stimulus *s = &c->stimulus[d->stimulus];
            double value = dalcs_stimulus_value(s, r->time, DALCS_RIGHT);
            r->shown[d->stimulus] = without_rounding(s, r->time, value);
        } else if (d->stimulus >= 0) {
            r->shown[d->stimulus] = r->value[d->stimulus];
        }
    }
    if (!r->is_certain && r->kind != DALCS_WITNESS_DERIVATIVE &&
        (c->n_devices == 0 || r->kind != DALCS_WITNESS_MODE)) {
        r->because = plain_list(r, "no values of these that were tried fulfil the equations");
    } else if (c->n_devices == 0) {
        r->because = explain_system(r);
    } else if (r->kind == DALCS_WITNESS_LOOP) {
        say_loop(r);
    } else if (r->kind == DALCS_WITNESS_CUTSET) {
        say_part(r);
    } else if (r->kind == DALCS_WITNESS_MODE) {
        r->because = explain_modes(r);
    } else {
        r->because = explain_derivative(r);
    }
    if (r->because == NULL) {
        r->because =
            plain_list(r, r->kind == DALCS_WITNESS_LOOP
                              ? "the sources drive current around this loop with nothing to "
                                "limit it"
                              : "the sources force a current that nothing in this cutset "
                                "lets pass");
    }
    r->because = r->because == NULL ? "" : r->because;
}

/* Does the loop have a coil, in which a current takes its time to grow, and a switch, which may open it before long? */
static bool is_loop_for_a_while(const struct dalcs_refusal *r) {
    bool has_coil = false;
    bool has_switch = false;
    for (int i = 0; i < r->circuit->n_devices; i++) {
        has_coil = has_coil || (r->is_named[i] && r->circuit->device[i].kind == DALCS_INDUCTOR);
        has_switch = has_switch || (r->is_named[i] && r->circuit->device[i].kind == DALCS_SWITCH);
    }
    return has_coil && has_switch;
}

bool dalcs_refusal_is_of_start(const struct dalcs_refusal *r) {
    const struct dalcs_transient *t = &r->circuit->analyses.transient;
    struct dalcs_fed_part part = {0};
    if (!r->is_static || !t->present || t->use_initial_conditions ||
        (r->kind == DALCS_WITNESS_CUTSET && dalcs_fed_part_find(r, &part) != DALCS_OK)) {
        return false;
    }
    bool has_capacitor = false;
    for (int i = 0; i < r->circuit->n_devices; i++) {
        has_capacitor |=
            r->circuit->device[i].kind == DALCS_CAPACITOR && (!part.found || part.blocks[i]);
    }
    return !r->is_certain ||
           (r->kind == DALCS_WITNESS_LOOP ? is_loop_for_a_while(r) : has_capacitor);
}
