/* refusal_words.c - lists, quantities and sources in the sentences of refusals. */
#include "refusal_words.h"

#include "quantity.h"

#include <string.h>

void dalcs_refusal_put(struct dalcs_refusal_list *l, const char *item) {
    if (l->n < DALCS_REFUSAL_MOST_LISTED) {
        l->item[l->n] = item == NULL ? "" : item;
    }
    l->n++;
}

const char *dalcs_refusal_joined(const struct dalcs_refusal_list *l, bool is_path) {
    const char *text = l->n > 0 ? l->item[0] : "";
    int n_said = l->n <= DALCS_REFUSAL_MOST_LISTED ? l->n : DALCS_REFUSAL_MOST_LISTED;
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

const char *dalcs_refusal_plural(const struct dalcs_refusal_list *l, const char *one,
                                 const char *many) {
    return l->n == 1 ? one : many;
}

const char *dalcs_refusal_quantity(struct dalcs_session *s, double value, const char *unit) {
    char text[DALCS_QUANTITY_SIZE];
    (void)dalcs_quantity_write(text, value, unit, 6);
    const char *copy = dalcs_arena_copy(&s->arena, text, strlen(text));
    return copy == NULL ? "" : copy;
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
const char *dalcs_refusal_source(const struct dalcs_refusal *r, int device, bool is_turning) {
    const struct dalcs_device *d = &r->circuit->device[device];
    const struct dalcs_stimulus *stimulus = &r->circuit->stimulus[d->stimulus];
    double slope = is_turning ? slope_at(stimulus, r->time) : 0.0;
    const char *value =
        dalcs_refusal_quantity(r->s, r->shown[d->stimulus], d->kind == DALCS_VSOURCE ? "V" : "A");
    return dalcs_arena_printf(&r->s->arena, "%s (%s%s)", d->name, value,
                              slope > 0.0   ? ", rising"
                              : slope < 0.0 ? ", falling"
                                            : "");
}
