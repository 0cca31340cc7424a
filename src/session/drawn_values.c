/* drawn_values.c - the values of random functions in the session's circuit, also in one that could not be built: then
 * these values explain the failure. */
#include "expand.h"
#include "session_internal.h"

#include <math.h>
#include <string.h>

static const struct dalcs_drawn_value *drawn_of(const struct dalcs_session *session, size_t *n) {
    *n = session->has_circuit ? (size_t)session->circuit.random.n_drawn : session->source.n_unbuilt;
    return session->has_circuit ? session->circuit.random.drawn : session->source.unbuilt;
}

const char *dalcs_session_drawn(const struct dalcs_session *session, size_t index, double *value) {
    const struct dalcs_steps *steps = &session->source.steps;
    size_t n;
    const struct dalcs_drawn_value *drawn = drawn_of(session, &n);
    if (!steps->is_known) {
        *value = index < n ? drawn[index].value : (double)NAN;
        return index < n ? drawn[index].name : NULL;
    }
    if (index >= steps->n_drawn) {
        return NULL;
    }
    /* nearly always at its place: a condition may have chosen other cards in this step */
    const char *name = steps->drawn[index];
    size_t k = index < n && strcmp(drawn[index].name, name) == 0 ? index : 0;
    while (k < n && strcmp(drawn[k].name, name) != 0) {
        k++;
    }
    *value = k < n ? drawn[k].value : (double)NAN;
    return name;
}

enum dalcs_status dalcs_drawn_keep_unbuilt(struct dalcs_session *session,
                                           const struct dalcs_override *override,
                                           size_t n_overrides) {
    struct dalcs_deck deck = {.override = override, .n_overrides = n_overrides};
    struct dalcs_diag unheard = {0}; /* all of it has been said */
    struct dalcs_arena *arena = &session->arena;
    enum dalcs_status status = dalcs_deck_expand(&deck, &session->source.netlist, &unheard);
    bool complete = status == DALCS_OK;
    session->source.unbuilt =
        dalcs_arena_alloc(arena, deck.n_drawn, sizeof *session->source.unbuilt);
    complete = complete && session->source.unbuilt != NULL;
    for (size_t k = 0; k < deck.n_drawn && complete; k++) {
        const char *name = deck.drawn[k].name;
        session->source.unbuilt[k] = (struct dalcs_drawn_value){
            dalcs_arena_copy(arena, name, strlen(name)), deck.drawn[k].value};
        complete = session->source.unbuilt[k].name != NULL;
    }
    session->source.n_unbuilt = complete ? deck.n_drawn : 0;
    dalcs_deck_finish(&deck);
    dalcs_diag_finish(&unheard);
    return complete ? DALCS_E_NETLIST : DALCS_E_NOMEM;
}
