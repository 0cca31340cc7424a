/* other_transient.c - .tran as a command line has it, in place of the netlist's. */
#include "netlist.h"

#include <string.h>

static bool is_transient(const struct dalcs_card *card) {
    return card->letter == '.' && strcmp(card->token[0].text, ".tran") == 0;
}

/* A place outside of all files, as messages call it. */
static struct dalcs_source_line *make_line(struct dalcs_netlist *netlist, const char *name,
                                           const char *text) {
    struct dalcs_source *source = dalcs_arena_alloc(&netlist->arena, 1, sizeof *source);
    struct dalcs_source_line *line = dalcs_arena_alloc(&netlist->arena, 1, sizeof *line);
    if (source == NULL || line == NULL) {
        return NULL;
    }
    *source = (struct dalcs_source){.name = name, .number = netlist->n_sources++};
    *line = (struct dalcs_source_line){.source = source, .text = text, .number = 1};
    return line;
}

/* The one card for all that there are, between .if and .endif, too. */
static enum dalcs_status replace_all(struct dalcs_netlist *netlist, struct dalcs_diag *diag) {
    const char *times = netlist->asks.transient;
    size_t n = 0;
    for (size_t k = 0; k < netlist->n_cards; k++) {
        if (!is_transient(&netlist->card[k])) {
            netlist->card[n++] = netlist->card[k];
        }
    }
    netlist->n_cards = n;
    times += strncmp(times, ".tran ", 6) == 0 ? 6 : 0; /* as it stands in a netlist */
    const char *text = dalcs_arena_printf(&netlist->arena, "tran %s", times);
    const struct dalcs_source_line *line = text != NULL ? make_line(netlist, "--tran", text) : NULL;
    return line != NULL ? dalcs_netlist_add_card(netlist, line, text, diag) : DALCS_E_NOMEM;
}

static bool is_time(const struct dalcs_token *token) {
    return token->kind == DALCS_TOKEN_EXPRESSION ||
           (token->kind == DALCS_TOKEN_WORD && strchr("+-.0123456789", token->text[0]) != NULL);
}

/* The second time is the end, or the only one. */
static enum dalcs_status replace_stop(struct dalcs_netlist *netlist, struct dalcs_card *card,
                                      const struct dalcs_token *stop) {
    const int at = card->n > 2 && is_time(&card->token[1]) && is_time(&card->token[2]) ? 2 : 1;
    if (at >= card->n || !is_time(&card->token[at])) {
        return DALCS_OK; /* it has none: that is an error of its own */
    }
    struct dalcs_token *token = dalcs_arena_alloc(&netlist->arena, (size_t)card->n, sizeof *token);
    if (token == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(token, card->token, (size_t)card->n * sizeof *token);
    token[at] = *stop;
    card->token = token;
    return DALCS_OK;
}

static enum dalcs_status replace_stops(struct dalcs_netlist *netlist, struct dalcs_diag *diag) {
    const char *text = netlist->asks.transient_stop;
    const struct dalcs_source_line *line = make_line(netlist, "--tstop", text);
    if (line == NULL) {
        return DALCS_E_NOMEM;
    }
    const struct dalcs_token stop = {.line = line,
                                     .text = text,
                                     .length = (unsigned)strlen(text) & DALCS_LONGEST_TOKEN,
                                     .kind = DALCS_TOKEN_WORD};
    bool found = false;
    for (size_t k = 0; k < netlist->n_cards; k++) {
        if (is_transient(&netlist->card[k])) {
            found = true;
            DALCS_TRY(replace_stop(netlist, &netlist->card[k], &stop));
        }
    }
    if (!found) {
        const struct dalcs_location where = dalcs_token_location(&stop);
        dalcs_diag_add(diag, DALCS_ERROR, &where, "--tran 'STEP STOP' makes one",
                       "the netlist has no .tran that could end at another time");
        netlist->has_errors = true;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_other_transient(struct dalcs_netlist *netlist, struct dalcs_diag *diag) {
    if (netlist->asks.transient != NULL) {
        DALCS_TRY(replace_all(netlist, diag));
    }
    return netlist->asks.transient_stop != NULL ? replace_stops(netlist, diag) : DALCS_OK;
}
