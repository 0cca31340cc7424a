/* script.c - what a .control block needs of a session: its lines, runs with cards of its own, other
 * values. The language of the block is not known here. */
#include "expand.h"
#include "orbit_analyses.h"

#include <string.h>

size_t dalcs_session_n_script_lines(const struct dalcs_session *session) {
    return session->source.has_netlist ? session->source.netlist.commands.n : 0;
}

const char *dalcs_session_script_line(const struct dalcs_session *session, size_t index) {
    return index < dalcs_session_n_script_lines(session)
               ? session->source.netlist.commands.line[index].text
               : NULL;
}

/* As messages call the lines that are added. */
static const char COMMANDS[] = "command";

enum dalcs_status dalcs_session_add_script_line(struct dalcs_session *session, const char *text) {
    struct dalcs_netlist *netlist = &session->source.netlist;
    if (dalcs_session_n_script_lines(session) == 0) {
        return DALCS_E_OPTION;
    }
    const struct dalcs_source_line last = netlist->commands.line[netlist->commands.n - 1];
    const struct dalcs_source *source = last.source;
    int number = last.number + 1;
    if (strcmp(source->name, COMMANDS) != 0) {
        struct dalcs_source *made = dalcs_arena_alloc(&netlist->arena, 1, sizeof *made);
        if (made == NULL) {
            return DALCS_E_NOMEM;
        }
        *made = (struct dalcs_source){.name = COMMANDS, .number = netlist->n_sources++};
        source = made;
        number = 1;
    }
    const char *own = dalcs_arena_copy(&netlist->arena, text, strlen(text));
    if (own == NULL) {
        return DALCS_E_NOMEM;
    }
    /* the circuit of the last run may name places in the lines that move here: it is built again */
    session->source.is_altered = true;
    const struct dalcs_source_line added = {.source = source, .text = own, .number = number};
    return dalcs_source_lines_add(&netlist->commands, added);
}

void dalcs_session_script_message(struct dalcs_session *session, size_t line, size_t column,
                                  size_t length, enum dalcs_level level, const char *hint,
                                  const char *text) {
    static const enum dalcs_severity severity[] = {[DALCS_LEVEL_NOTE] = DALCS_NOTE,
                                                   [DALCS_LEVEL_WARNING] = DALCS_WARNING,
                                                   [DALCS_LEVEL_ERROR] = DALCS_ERROR};

    if (line >= dalcs_session_n_script_lines(session)) {
        dalcs_diag_add(&session->diag, severity[level], NULL, hint, "%s", text);
        return;
    }
    const struct dalcs_token place = {.line = &session->source.netlist.commands.line[line],
                                      .offset = (int)column - 1,
                                      .length = (int)length};
    const struct dalcs_location where = dalcs_token_location(&place);
    dalcs_diag_add(&session->diag, severity[level], &where, hint, "%s", text);
}

/* ---- Runs with cards of their own ------------------------------------------------------------- */

static bool is_analysis(const struct dalcs_card *card) {
    static const char *const name[] = {".tran", ".op", ".dc", ".ac", ".tf", ".step", ".mc"};
    for (size_t k = 0; k < sizeof name / sizeof name[0]; k++) {
        if (strcmp(card->token->text, name[k]) == 0) {
            return true;
        }
    }
    return false;
}

/* Keeps the analyses among the last cards and drops those before; undone by `before`. */
static enum dalcs_status use_own_analyses(struct dalcs_session *s, size_t first) {
    struct dalcs_netlist *netlist = &s->source.netlist;
    bool has_own = false;
    for (size_t k = first; k < netlist->n_cards; k++) {
        has_own = has_own || is_analysis(&netlist->card[k]);
    }
    size_t n = 0;
    for (size_t k = 0; k < netlist->n_cards; k++) {
        if (!has_own || k >= first || !is_analysis(&netlist->card[k])) {
            netlist->card[n++] = netlist->card[k];
        }
    }
    netlist->n_cards = n;
    return DALCS_OK;
}

/* A second analysis, where it is not NULL, and other cards beside the netlist's own. */
static enum dalcs_status run_with(struct dalcs_session *session,
                                  const struct dalcs_source_line *second,
                                  const struct dalcs_extra_card *card, size_t n_cards,
                                  const struct dalcs_run_options *options,
                                  const struct dalcs_sink *sink) {
    for (size_t k = 0; k < n_cards; k++) {
        if (card[k].line >= dalcs_session_n_script_lines(session)) {
            return DALCS_E_OPTION;
        }
    }
    struct dalcs_netlist *netlist = &session->source.netlist;
    const struct dalcs_netlist before = *netlist;
    struct dalcs_card *kept = dalcs_alloc(before.n_cards, sizeof *kept);
    if (kept == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(kept, before.card, before.n_cards * sizeof *kept);
    enum dalcs_status status = DALCS_OK;
    for (size_t k = 0; k < n_cards && status == DALCS_OK; k++) {
        status = dalcs_netlist_add_card(netlist, &netlist->commands.line[card[k].line],
                                        card[k].text, &session->diag);
    }
    if (status == DALCS_OK && second != NULL) {
        status = dalcs_netlist_add_card(netlist, second, second->text, &session->diag);
    }
    if (status == DALCS_OK) {
        status = use_own_analyses(session, before.n_cards);
    }
    if (status == DALCS_OK) {
        session->source.is_altered = true;
        status = dalcs_session_run(session, options, sink);
    }
    memcpy(netlist->card, kept, before.n_cards * sizeof *kept);
    netlist->n_cards = before.n_cards;
    netlist->has_errors = before.has_errors;
    netlist->has_language = before.has_language;
    session->source.is_altered = true;
    free(kept);
    return status;
}

enum dalcs_status dalcs_session_run_cards(struct dalcs_session *session,
                                          const struct dalcs_extra_card *card, size_t n_cards,
                                          const struct dalcs_run_options *options,
                                          const struct dalcs_sink *sink) {
    return session->source.has_netlist ? run_with(session, NULL, card, n_cards, options, sink)
                                       : DALCS_E_OPTION;
}

size_t dalcs_session_n_second_analyses(const struct dalcs_session *session) {
    return session->source.has_netlist ? session->source.netlist.later.n : 0;
}

enum dalcs_status dalcs_session_run_second(struct dalcs_session *session, size_t index,
                                           const struct dalcs_extra_card *card, size_t n_cards,
                                           const struct dalcs_run_options *options,
                                           const struct dalcs_sink *sink) {
    return index < dalcs_session_n_second_analyses(session)
               ? run_with(session, &session->source.netlist.later.line[index], card, n_cards,
                          options, sink)
               : DALCS_E_OPTION;
}

/* ---- Other values ------------------------------------------------------------------------------ */

static bool is_same(const struct dalcs_override *a, const struct dalcs_override *b) {
    const bool same_field = (a->field == NULL) == (b->field == NULL) &&
                            (a->field == NULL || strcmp(a->field, b->field) == 0);
    return a->kind == b->kind && strcmp(a->name, b->name) == 0 && same_field;
}

/* Takes it out of the list: names that are there again need no other memory. */
static struct dalcs_override take_out(struct dalcs_session *s,
                                      const struct dalcs_override *override) {
    struct dalcs_override taken = {.name = NULL};
    size_t n = 0;
    for (size_t k = 0; k < s->source.n_altered; k++) {
        if (is_same(&s->source.override[k], override)) {
            taken = s->source.override[k];
        } else {
            s->source.override[n++] = s->source.override[k];
        }
    }
    s->source.n_altered = n;
    return taken;
}

/* Behind all others, since of two functions of a source the later one counts. */
static enum dalcs_status keep_override(struct dalcs_session *s,
                                       const struct dalcs_override *override) {
    double *list = NULL;
    if (override->n_list > 0) {
        list = dalcs_arena_alloc(&s->arena, override->n_list, sizeof *list);
        if (list == NULL) {
            return DALCS_E_NOMEM;
        }
        memcpy(list, override->list, override->n_list * sizeof *list);
    }
    s->source.is_altered = true;
    const struct dalcs_override before = take_out(s, override);
    struct dalcs_override own = *override;
    own.list = list;
    own.name = before.name;
    own.field = before.field;
    if (before.name == NULL) {
        DALCS_TRY(dalcs_grow(&s->source.override, &s->source.override_capacity,
                             s->source.n_altered + 1, sizeof *s->source.override));
        own.name = dalcs_arena_copy(&s->arena, override->name, strlen(override->name));
        own.field = override->field == NULL
                        ? NULL
                        : dalcs_arena_copy(&s->arena, override->field, strlen(override->field));
        if (own.name == NULL || (override->field != NULL && own.field == NULL)) {
            return DALCS_E_NOMEM;
        }
    }
    s->source.override[s->source.n_altered++] = own;
    return DALCS_OK;
}

/* Is there a card whose word number `index` is the name, after a first word `head` (NULL: any)? */
static bool has_card(const struct dalcs_netlist *netlist, const char *head, int index,
                     const char *name, const char **nearest) {
    for (size_t k = 0; k < netlist->n_cards; k++) {
        const struct dalcs_card *card = &netlist->card[k];
        if (index >= card->n || (head != NULL && strcmp(card->token->text, head) != 0)) {
            continue;
        }
        const char *text = card->token[index].text;
        if (strcmp(text, name) == 0) {
            return true;
        }
        *nearest = *nearest != NULL ? *nearest : dalcs_names_nearest_of(&text, 1, name);
    }
    return false;
}

static bool has_device(const struct dalcs_circuit *circuit, const char *name,
                       const char **nearest) {
    for (int k = 0; k < circuit->n_devices; k++) {
        const char *text = circuit->device[k].name;
        if (strcmp(text, name) == 0) {
            return true;
        }
        *nearest = *nearest != NULL ? *nearest : dalcs_names_nearest_of(&text, 1, name);
    }
    return false;
}

static bool has_parameter(const struct dalcs_netlist *netlist, const char *name,
                          const char **nearest) {
    for (size_t k = 0; k < netlist->n_cards; k++) {
        const struct dalcs_card *card = &netlist->card[k];
        const bool declares = strncmp(card->token->text, ".param", strlen(".param")) == 0 ||
                              strcmp(card->token->text, ".csparam") == 0 ||
                              strcmp(card->token->text, ".global_param") == 0;
        for (int i = 1; declares && i + 1 < card->n; i++) {
            const char *text = card->token[i].text;
            if (card->token[i + 1].kind == DALCS_TOKEN_EQUAL) {
                if (strcmp(text, name) == 0) {
                    return true;
                }
                *nearest = *nearest != NULL ? *nearest : dalcs_names_nearest_of(&text, 1, name);
            }
        }
    }
    return false;
}

enum dalcs_status dalcs_session_alter(struct dalcs_session *session, bool is_parameter,
                                      const char *name, const char *field, double value,
                                      const char **nearest) {
    const char *unused = NULL;
    const char **like = nearest != NULL ? nearest : &unused;
    struct dalcs_override override = {
        .kind = DALCS_OVERRIDE_ELEMENT, .name = name, .field = field, .value = value};
    bool found;
    *like = NULL;
    if (!session->source.has_netlist) {
        return DALCS_E_OPTION;
    }
    dalcs_steady_anchor_forget(session);
    if (is_parameter) {
        override.kind = DALCS_OVERRIDE_PARAMETER;
        found = has_parameter(&session->source.netlist, name, like);
    } else if (field != NULL) {
        override.kind = DALCS_OVERRIDE_MODEL;
        found = has_card(&session->source.netlist, ".model", 1, name, like);
    } else {
        found = (session->has_circuit && has_device(&session->circuit, name, like)) ||
                has_card(&session->source.netlist, NULL, 0, name, like);
    }
    return found ? keep_override(session, &override) : DALCS_E_OPTION;
}

enum dalcs_status dalcs_session_alter_waveform(struct dalcs_session *session, const char *name,
                                               const char *function, const double *value, size_t n,
                                               const char **nearest) {
    const char *unused = NULL;
    const char **like = nearest != NULL ? nearest : &unused;
    const struct dalcs_override override = {.kind = DALCS_OVERRIDE_WAVEFORM,
                                            .name = name,
                                            .field = function,
                                            .list = value,
                                            .n_list = n};
    bool found = false;
    *like = NULL;
    for (int k = 0; session->has_circuit && k < session->circuit.n_devices; k++) {
        const struct dalcs_device *d = &session->circuit.device[k];
        const bool is_source = d->kind == DALCS_VSOURCE || d->kind == DALCS_ISOURCE;
        found = found || (is_source && strcmp(d->name, name) == 0);
        *like = is_source && *like == NULL ? dalcs_names_nearest_of(&d->name, 1, name) : *like;
    }
    return found ? keep_override(session, &override) : DALCS_E_OPTION;
}

enum dalcs_status dalcs_session_parameter(const struct dalcs_session *session, const char *name,
                                          double *value) {
    const char *nearest = NULL;
    if (!session->source.has_netlist || !has_parameter(&session->source.netlist, name, &nearest)) {
        return DALCS_E_OPTION;
    }
    struct dalcs_deck deck = {.override = session->source.override,
                              .n_overrides = session->source.n_altered};
    struct dalcs_diag unheard = {0}; /* the circuit was built: all of it has been said */
    enum dalcs_status status = dalcs_deck_settle(&deck, &session->source.netlist, &unheard);
    if (status == DALCS_OK && !dalcs_deck_parameter(&deck, name, value)) {
        status = DALCS_E_OPTION;
    }
    dalcs_deck_finish(&deck);
    dalcs_diag_finish(&unheard);
    return status;
}

void dalcs_session_reset(struct dalcs_session *session) {
    size_t n = 0;
    for (size_t k = 0; k < session->source.n_altered; k++) {
        if (session->source.override[k].kind == DALCS_OVERRIDE_PARAMETER) {
            session->source.override[n++] = session->source.override[k];
        }
    }
    const bool draws = session->has_circuit && session->circuit.random.is_random;
    session->source.is_altered =
        session->source.is_altered || n < session->source.n_altered || draws;
    session->source.n_altered = n;
    session->source.n_resets += draws ? 1 : 0; /* as ngspice, whose .param are evaluated again */
}
