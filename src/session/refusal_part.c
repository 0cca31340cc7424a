/* refusal_part.c - a part of a circuit that is fed, as a sentence: what forces current, where, and what blocks. */
#include "refusal_words.h"

#include <math.h>

static const char *part_text(const struct dalcs_refusal *r, const struct dalcs_fed_part *part,
                             int *n) {
    struct dalcs_refusal_list nodes = {.s = r->s};
    for (int k = 0; k < r->circuit->n_nodes; k++) {
        if (part->contains[k]) {
            dalcs_refusal_put(&nodes, r->circuit->node_name[k]);
        }
    }
    *n = nodes.n;
    return dalcs_arena_printf(&r->s->arena, "%s %s", dalcs_refusal_plural(&nodes, "node", "nodes"),
                              dalcs_refusal_joined(&nodes, false));
}

static const char *blockers_text(const struct dalcs_refusal *r, const struct dalcs_fed_part *part) {
    struct dalcs_session *s = r->s;
    struct dalcs_refusal_list diodes = {.s = s};
    struct dalcs_refusal_list switches = {.s = s};
    struct dalcs_refusal_list capacitors = {.s = s};
    struct dalcs_refusal_list all = {.s = s};
    for (int i = 0; i < r->circuit->n_devices; i++) {
        const struct dalcs_device *d = &r->circuit->device[i];
        if (part->blocks[i]) {
            dalcs_refusal_put(d->kind == DALCS_DIODE    ? &diodes
                              : d->kind == DALCS_SWITCH ? &switches
                                                        : &capacitors,
                              d->name);
        }
    }
    if (diodes.n > 0) {
        dalcs_refusal_put(
            &all, dalcs_arena_printf(&s->arena, "%s %s", dalcs_refusal_joined(&diodes, false),
                                     dalcs_refusal_plural(&diodes, "blocks", "block")));
    }
    if (switches.n > 0) {
        dalcs_refusal_put(&all, dalcs_arena_printf(&s->arena, "%s %s open",
                                                   dalcs_refusal_joined(&switches, false),
                                                   dalcs_refusal_plural(&switches, "is", "are")));
    }
    if (capacitors.n > 0) {
        dalcs_refusal_put(
            &all, dalcs_arena_printf(&s->arena, "at the operating point %s %s no current",
                                     dalcs_refusal_joined(&capacitors, false),
                                     dalcs_refusal_plural(&capacitors, "carries", "carry")));
    }
    return all.n == 0 ? ""
                      : dalcs_arena_printf(&s->arena, ": %s", dalcs_refusal_joined(&all, true));
}

const char *dalcs_refusal_of_part(const struct dalcs_refusal *r,
                                  const struct dalcs_fed_part *part) {
    struct dalcs_session *s = r->s;
    const struct dalcs_circuit *c = r->circuit;
    struct dalcs_refusal_list with = {.s = s};
    struct dalcs_refusal_list against = {.s = s};
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
    bool is_turning = r->is_from && !(net > DALCS_TURNING_PART * size);
    for (int i = 0; i < c->n_devices; i++) {
        if (part->into[i] != 0.0) {
            bool helps = (part->into[i] > 0.0) == part->is_filled;
            dalcs_refusal_put(helps ? &with : &against, dalcs_refusal_source(r, i, is_turning));
        }
    }
    int n_nodes;
    const char *nodes = part_text(r, part, &n_nodes);
    const char *it = n_nodes == 1 ? "it" : "them";
    const char *way = part->is_filled ? "into" : "out of";
    const char *other = part->is_filled ? "out of" : "into";
    const char *rest = against.n == 0 ? ""
                       : is_turning
                           ? dalcs_arena_printf(&s->arena, " and %s %s %s",
                                                dalcs_refusal_joined(&against, false), other, it)
                           : dalcs_arena_printf(&s->arena, " and %s %s %s (net %s)",
                                                dalcs_refusal_joined(&against, false), other, it,
                                                dalcs_refusal_quantity(s, net, "A"));
    const char *blockers = blockers_text(r, part);
    return dalcs_arena_printf(
        &s->arena, "%s %s %s %s%s, and nothing lets %s %s%s", dalcs_refusal_joined(&with, false),
        dalcs_refusal_plural(&with, "flows", "flow"), way, nodes == NULL ? "" : nodes,
        rest == NULL ? "" : rest, against.n > 0 ? "the rest" : "it", part->is_filled ? "out" : "in",
        blockers == NULL ? "" : blockers);
}
