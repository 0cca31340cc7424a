/* refusal.c - why there is no solution, as a sentence: what drives or forces, which way, where, against
 * what, and what blocks. */
#include "refusal.h"

#include "quantity.h"
#include "union_find.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Elements of a kind that a sentence lists, and nodes. */
enum { MOST_LISTED = 12 };

/* What is left over, as a part of the sources, when they have only just stopped to agree. */
static const double turning_part = 1e-6;

/* Items of a sentence, in the arena. */
struct list {
    struct dalcs_session *s;
    int n;
    const char *item[MOST_LISTED];
};

static void put(struct list *l, const char *item) {
    if (l->n < MOST_LISTED) {
        l->item[l->n] = item == NULL ? "" : item;
    }
    l->n++;
}

/* "a", "a and b", "a, b and c", "a, b and 7 more"; with commas alone as a path is listed. */
static const char *joined(const struct list *l, bool is_path) {
    const char *text = l->n > 0 ? l->item[0] : "";
    int n_said = l->n <= MOST_LISTED ? l->n : MOST_LISTED;
    for (int k = 1; k < n_said && text != NULL; k++) {
        bool is_last = k == l->n - 1;
        text = dalcs_arena_printf(&l->s->arena, "%s%s%s", text,
                                  is_last && !is_path ? " and " : ", ", l->item[k]);
    }
    if (l->n > n_said && text != NULL) {
        text = dalcs_arena_printf(&l->s->arena, "%s and %d more", text, l->n - n_said);
    }
    return text == NULL ? "" : text;
}

static const char *plural(const struct list *l, const char *one, const char *many) {
    return l->n == 1 ? one : many;
}

/* "5 V", "2.5 mA" */
static const char *quantity(struct dalcs_session *s, double value, const char *unit) {
    char text[DALCS_QUANTITY_SIZE];
    (void)dalcs_quantity_write(text, value, unit, 6);
    const char *copy = dalcs_arena_copy(&s->arena, text, strlen(text));
    return copy == NULL ? "" : copy;
}

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

static double slope_at(const struct dalcs_stimulus *s, double t) {
    struct dalcs_stimulus_term terms[DALCS_STIMULUS_MOST_TERMS];
    struct dalcs_stimulus_piece piece = {.term = terms};
    dalcs_stimulus_piece_at(s, t, &piece);
    double slope = piece.slope;
    for (int k = 0; k < piece.n_terms; k++) {
        const struct dalcs_stimulus_term *term = &piece.term[k];
        slope += term->omega * term->sine - term->decay * term->cosine;
    }
    return slope;
}

/* "v1 (5 V)", "v1 (0 V, rising)". */
static const char *source_text(const struct dalcs_refusal *r, int device, bool is_turning) {
    const struct dalcs_device *d = &r->circuit->device[device];
    const struct dalcs_stimulus *stimulus = &r->circuit->stimulus[d->stimulus];
    double slope = is_turning ? slope_at(stimulus, r->time) : 0.0;
    const char *value = quantity(r->s, r->shown[d->stimulus], d->kind == DALCS_VSOURCE ? "V" : "A");
    return dalcs_arena_printf(&r->s->arena, "%s (%s%s)", d->name, value,
                              slope > 0.0   ? ", rising"
                              : slope < 0.0 ? ", falling"
                                            : "");
}

/* ---- Loops --------------------------------------------------------------------------------- */

struct loop_words {
    struct list drivers, opposers, forward, broken, path, closed, coils;
    double net, size; /* V, of what is shown */
};

static double shown_gain(const struct dalcs_refusal *r, const struct dalcs_loop_arc *a) {
    const struct dalcs_device *d = a->device < 0 ? NULL : &r->circuit->device[a->device];
    if (d == NULL || d->kind != DALCS_VSOURCE) {
        return a->gain;
    }
    return a->to == d->node[0] ? r->shown[d->stimulus] : -r->shown[d->stimulus];
}

static const char *held_text(const struct dalcs_refusal *r, int k, bool with_value) {
    const struct dalcs_initial_condition *ic = &r->circuit->initial_condition[k];
    const char *const *node = r->circuit->node_name;
    struct dalcs_arena *arena = &r->s->arena;
    const char *name = ic->node[1] == 0 ? dalcs_arena_printf(arena, ".ic v(%s)", node[ic->node[0]])
                                        : dalcs_arena_printf(arena, ".ic v(%s,%s)",
                                                             node[ic->node[0]], node[ic->node[1]]);
    return name != NULL && with_value
               ? dalcs_arena_printf(arena, "%s (%s)", name, quantity(r->s, ic->value, "V"))
               : name;
}

static void add_diode(const struct dalcs_refusal *r, struct loop_words *w,
                      const struct dalcs_loop_arc *a) {
    const struct dalcs_device *d = &r->circuit->device[a->device];
    bool is_forward = a->from == d->node[0];
    put(is_forward ? &w->forward : &w->broken, d->name);
    if (a->gain != 0.0) {
        put(&w->opposers,
            dalcs_arena_printf(&r->s->arena, "%s of %s (%s)", is_forward ? "vfwd" : "vrev", d->name,
                               quantity(r->s, -a->gain, "V")));
    }
}

static void add_part(const struct dalcs_refusal *r, struct loop_words *w,
                     const struct dalcs_loop_arc *a, bool is_turning) {
    const struct dalcs_device *d = a->device < 0 ? NULL : &r->circuit->device[a->device];
    put(&w->path, d != NULL ? d->name : held_text(r, ~a->device, false));
    if (d == NULL) {
        put(a->gain > 0.0 ? &w->drivers : &w->opposers, held_text(r, ~a->device, true));
    } else if (d->kind == DALCS_VSOURCE && a->gain != 0.0) {
        put(a->gain > 0.0 ? &w->drivers : &w->opposers, source_text(r, a->device, is_turning));
    } else if (d->kind == DALCS_DIODE) {
        add_diode(r, w, a);
    } else if (d->kind == DALCS_SWITCH) {
        put(&w->closed, d->name);
    } else if (d->kind == DALCS_INDUCTOR) {
        put(&w->coils, d->name);
    }
}

static const char *loop_sentence(struct dalcs_session *s, const struct loop_words *w,
                                 bool is_turning) {
    struct list effect = {.s = s};
    if (w->forward.n > 0) {
        put(&effect, dalcs_arena_printf(&s->arena, "%s forward", joined(&w->forward, false)));
    }
    if (w->broken.n > 0) {
        put(&effect, dalcs_arena_printf(&s->arena, "%s into breakdown", joined(&w->broken, false)));
    }
    if (effect.n == 0) {
        put(&effect, "current");
    }
    const char *against = w->opposers.n > 0 ? dalcs_arena_printf(&s->arena, " against %s",
                                                                 joined(&w->opposers, false))
                                            : "";
    const char *net = w->drivers.n + w->opposers.n > 1 && !is_turning
                          ? dalcs_arena_printf(&s->arena, " (net %s)", quantity(s, w->net, "V"))
                          : "";
    const char *closed =
        w->closed.n > 0 ? dalcs_arena_printf(&s->arena, "; %s %s closed", joined(&w->closed, false),
                                             plural(&w->closed, "is", "are"))
                        : "";
    const char *coils = w->coils.n > 0
                            ? dalcs_arena_printf(&s->arena, "; at the operating point %s %s",
                                                 joined(&w->coils, false),
                                                 plural(&w->coils, "is a short", "are shorts"))
                            : "";
    return dalcs_arena_printf(
        &s->arena, "%s %s %s%s around the loop %s%s with nothing to limit the current%s%s",
        joined(&w->drivers, false), plural(&w->drivers, "drives", "drive"), joined(&effect, false),
        against == NULL ? "" : against, joined(&w->path, true), net == NULL ? "" : net,
        closed == NULL ? "" : closed, coils == NULL ? "" : coils);
}

static const char *explain_loop(struct dalcs_refusal *r, const struct dalcs_loop_arc *arc,
                                int n_arcs) {
    struct dalcs_session *s = r->s;
    struct loop_words w = {.drivers = {.s = s},
                           .opposers = {.s = s},
                           .forward = {.s = s},
                           .broken = {.s = s},
                           .path = {.s = s},
                           .closed = {.s = s},
                           .coils = {.s = s}};
    for (int k = 0; k < n_arcs; k++) {
        w.net += shown_gain(r, &arc[k]);
        w.size += fabs(shown_gain(r, &arc[k]));
    }
    bool is_turning = r->is_from && !(w.net > turning_part * w.size);
    for (int k = 0; k < n_arcs; k++) {
        add_part(r, &w, &arc[k], is_turning);
    }
    return loop_sentence(s, &w, is_turning);
}

/* Through transformers a loop is not one path: its elements, and what couples them. */
static const char *explain_coupled(struct dalcs_refusal *r) {
    struct dalcs_session *s = r->s;
    const struct dalcs_circuit *c = r->circuit;
    struct list driver = {.s = s};
    struct list path = {.s = s};
    struct list coils = {.s = s};
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (r->is_named[i]) {
            put(&path, d->name);
        }
        if (r->is_named[i] && d->kind == DALCS_VSOURCE && r->value[d->stimulus] != 0.0) {
            put(&driver, source_text(r, i, r->is_from && r->shown[d->stimulus] == 0.0));
        }
    }
    for (int k = 0; k < c->n_couplings; k++) {
        const int *coil = c->coupling[k].inductor;
        if (fabs(c->coupling[k].k) == 1.0 && r->is_named[coil[0]] && r->is_named[coil[1]]) {
            put(&coils, c->coupling[k].name);
        }
    }
    const char *coupled = coils.n > 0 ? dalcs_arena_printf(&s->arena,
                                                           "; the coils of %s are an ideal "
                                                           "transformer",
                                                           joined(&coils, false))
                                      : "";
    return dalcs_arena_printf(&s->arena, "%s %s current through %s with nothing to limit it%s",
                              driver.n > 0 ? joined(&driver, false) : "the sources",
                              driver.n == 1 ? "drives" : "drive", joined(&path, true),
                              coupled == NULL ? "" : coupled);
}

/* ---- Parts that are fed -------------------------------------------------------------------- */

static const char *part_text(const struct dalcs_refusal *r, const struct dalcs_fed_part *part,
                             int *n) {
    struct list nodes = {.s = r->s};
    for (int k = 0; k < r->circuit->n_nodes; k++) {
        if (part->contains[k]) {
            put(&nodes, r->circuit->node_name[k]);
        }
    }
    *n = nodes.n;
    return dalcs_arena_printf(&r->s->arena, "%s %s", plural(&nodes, "node", "nodes"),
                              joined(&nodes, false));
}

static const char *blockers_text(const struct dalcs_refusal *r, const struct dalcs_fed_part *part) {
    struct dalcs_session *s = r->s;
    struct list diodes = {.s = s};
    struct list switches = {.s = s};
    struct list capacitors = {.s = s};
    struct list all = {.s = s};
    for (int i = 0; i < r->circuit->n_devices; i++) {
        const struct dalcs_device *d = &r->circuit->device[i];
        if (part->blocks[i]) {
            put(d->kind == DALCS_DIODE    ? &diodes
                : d->kind == DALCS_SWITCH ? &switches
                                          : &capacitors,
                d->name);
        }
    }
    if (diodes.n > 0) {
        put(&all, dalcs_arena_printf(&s->arena, "%s %s", joined(&diodes, false),
                                     plural(&diodes, "blocks", "block")));
    }
    if (switches.n > 0) {
        put(&all, dalcs_arena_printf(&s->arena, "%s %s open", joined(&switches, false),
                                     plural(&switches, "is", "are")));
    }
    if (capacitors.n > 0) {
        put(&all, dalcs_arena_printf(&s->arena, "at the operating point %s %s no current",
                                     joined(&capacitors, false),
                                     plural(&capacitors, "carries", "carry")));
    }
    return all.n == 0 ? "" : dalcs_arena_printf(&s->arena, ": %s", joined(&all, true));
}

/* "i1 (3 A) flows into node 1 and i2 (1 A) out of it (net 2 A), and nothing lets the rest out: d1
 * blocks" */
static const char *explain_part(const struct dalcs_refusal *r, const struct dalcs_fed_part *part) {
    struct dalcs_session *s = r->s;
    const struct dalcs_circuit *c = r->circuit;
    struct list with = {.s = s};
    struct list against = {.s = s};
    double net = 0.0;
    double size = 0.0;
    for (int i = 0; i < c->n_devices; i++) {
        if (part->into[i] != 0.0) {
            double shown = r->shown[c->device[i].stimulus];
            net +=
                (part->into[i] > 0.0) == (r->value[c->device[i].stimulus] > 0.0) ? shown : -shown;
            size += fabs(shown);
        }
    }
    net = part->is_filled ? net : -net;
    bool is_turning = r->is_from && !(net > turning_part * size);
    for (int i = 0; i < c->n_devices; i++) {
        if (part->into[i] != 0.0) {
            bool helps = (part->into[i] > 0.0) == part->is_filled;
            put(helps ? &with : &against, source_text(r, i, is_turning));
        }
    }
    int n_nodes;
    const char *nodes = part_text(r, part, &n_nodes);
    const char *it = n_nodes == 1 ? "it" : "them";
    const char *way = part->is_filled ? "into" : "out of";
    const char *other = part->is_filled ? "out of" : "into";
    const char *rest =
        against.n == 0 ? ""
        : is_turning
            ? dalcs_arena_printf(&s->arena, " and %s %s %s", joined(&against, false), other, it)
            : dalcs_arena_printf(&s->arena, " and %s %s %s (net %s)", joined(&against, false),
                                 other, it, quantity(s, net, "A"));
    const char *blockers = blockers_text(r, part);
    return dalcs_arena_printf(&s->arena, "%s %s %s %s%s, and nothing lets %s %s%s",
                              joined(&with, false), plural(&with, "flows", "flow"), way,
                              nodes == NULL ? "" : nodes, rest == NULL ? "" : rest,
                              against.n > 0 ? "the rest" : "it", part->is_filled ? "out" : "in",
                              blockers == NULL ? "" : blockers);
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
static void list_active(const struct dalcs_refusal *r, struct list *active) {
    for (int i = 0; i < r->circuit->n_devices; i++) {
        if (dalcs_osnsp_acts_on_what_it_reads(r->osnsp, r->circuit->device[i].name)) {
            put(active, r->circuit->device[i].name);
        }
    }
}

static const char *explain_modes(const struct dalcs_refusal *r) {
    struct list named = {.s = r->s};
    struct list active = {.s = r->s};
    for (size_t k = 0; k < r->n_elements; k++) {
        put(&named, device_of(r->circuit, r->element[k]) >= 0
                        ? r->element[k]
                        : dalcs_arena_printf(&r->s->arena, "node %s", r->element[k]));
    }
    list_active(r, &active);
    int first = r->n_elements > 0 ? device_of(r->circuit, r->element[0]) : -1;
    bool is_formula = first >= 0 && r->circuit->device[first].behaviour != NULL;
    const char *format =
        !r->is_certain && !has_modes(r) ? "the best answer that was tried fits worst at %s"
        : !r->is_certain ? "no combination of conducting and blocking that was tried fits %s"
        : !has_modes(r)  ? "the equations contradict each other, most at %s"
        : named.n == 1 && is_formula ? "%s fits no piece of its formula"
        : named.n == 1               ? "%s fits neither conducting nor blocking"
                                     : "no combination of conducting and blocking fits %s";
    const char *what = dalcs_arena_printf(&r->s->arena, format, joined(&named, false));
    if (active.n == 0 || what == NULL) {
        return what;
    }
    return dalcs_arena_printf(&r->s->arena, "%s; %s %s the circuit from being passive", what,
                              joined(&active, false), plural(&active, "keeps", "keep"));
}

/* ---- Jumps --------------------------------------------------------------------------------- */

static const char *explain_derivative(const struct dalcs_refusal *r) {
    struct list named = {.s = r->s};
    for (size_t k = 0; k < r->n_elements; k++) {
        put(&named, r->element[k]);
    }
    return dalcs_arena_printf(
        &r->s->arena,
        !r->is_certain ? "%s would have to jump farther in each shorter step that was tried"
                       : "%s would have to jump by the derivative of an impulse, which no "
                         "vanishing step approaches; start from values that need none",
        joined(&named, false));
}

/* ---- All together -------------------------------------------------------------------------- */

static const char *plain_list(const struct dalcs_refusal *r, const char *why) {
    struct list l = {.s = r->s};
    for (size_t k = 0; k < r->n_elements; k++) {
        put(&l, r->element[k]);
    }
    return dalcs_arena_printf(&r->s->arena, "%s: %s", joined(&l, false), why);
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

static void say_loop(struct dalcs_refusal *r) {
    size_t most = 2 * (r->n_elements + (size_t)r->circuit->n_initial_conditions) + 1;
    struct dalcs_loop_arc *arc = dalcs_arena_alloc(&r->s->arena, most, sizeof(*arc));
    const char **name = room_for_names(r, most);
    int n = 0;
    if (arc == NULL || name == NULL || dalcs_driven_loop_find(r, arc, &n) != DALCS_OK) {
        return;
    }
    if (n == 0) {
        order_as_netlist(r);
        r->because = explain_coupled(r);
        return;
    }
    for (int k = 0; k < n; k++) {
        name[k] = arc[k].device < 0 ? ".ic" : r->circuit->device[arc[k].device].name;
    }
    r->element = name;
    r->n_elements = (size_t)n;
    r->because = explain_loop(r, arc, n);
}

static void say_part(struct dalcs_refusal *r) {
    struct dalcs_fed_part part;
    if (dalcs_fed_part_find(r, &part) != DALCS_OK || !part.found) {
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
    r->because = explain_part(r, &part);
}

/* Of a system file, which has no elements but names. */
static const char *explain_system(const struct dalcs_refusal *r) {
    static const char *const why[] = {
        [DALCS_WITNESS_LOOP] = "no multipliers and unknowns of these names fulfil the equations",
        [DALCS_WITNESS_CUTSET] = "no values of these names fulfil the equations",
        [DALCS_WITNESS_MODE] = "no combination of w = 0 and lambda = 0 fits",
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
