/* commands.c - commands that src/script leaves to its host. */
#include "library.h"

#include "lower_case.h"
#include "signal_name.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

/* The word at *text, which moves behind it; "" at the end. */
static const char *next_word(const char **text, char *word, size_t size) {
    const char *begin = *text + strspn(*text, " \t,");
    const size_t n = strcspn(begin, " \t,");
    snprintf(word, size, "%.*s", (int)n, begin);
    *text = begin + n;
    return dalcs_lower_text(word);
}

static enum dalcs_status fail(struct ng_library *l) {
    l->fails = true;
    return DALCS_E_NETLIST;
}

/* ---- Plots ---------------------------------------------------------------------------------------- */

static enum dalcs_status setplot(struct ng_library *l, const char *rest) {
    char word[64];
    next_word(&rest, word, sizeof word);
    if (word[0] == '\0') {
        for (size_t k = l->plots.n; k-- > 0;) {
            const struct ng_plot *plot = l->plots.plot[k];
            fprintf(l->talk.out, "%s%s\t%s (%s)\n", k == l->plots.current ? "Current " : "\t",
                    plot->type, plot->title, plot->kind);
        }
        return DALCS_OK;
    }
    DALCS_TRY(ng_take_vectors(l));
    if (strcmp(word, "new") == 0) {
        DALCS_TRY(ng_plots_make(&l->plots, "unknown", "Anonymous", "Anonymous"));
    } else if (!ng_plots_choose(&l->plots, word)) {
        ng_talk_fail(&l->talk, "setplot: there is no plot '%s'", word);
        return fail(l);
    }
    return ng_lend_vectors(l);
}

enum dalcs_status ng_commands_hear_set(struct ng_library *l, const char *rest) {
    char word[64];
    const char *equal = strchr(rest, '=');
    if (equal == NULL || strcmp(next_word(&rest, word, sizeof word), "curplot") != 0) {
        return DALCS_OK;
    }
    equal++;
    next_word(&equal, word, sizeof word);
    return setplot(l, word);
}

static enum dalcs_status destroy(struct ng_library *l, const char *rest) {
    char word[64];
    DALCS_TRY(ng_take_vectors(l));
    next_word(&rest, word, sizeof word);
    do {
        if (strcmp(word, "all") == 0) {
            ng_plots_destroy_all(&l->plots);
        } else if (word[0] == '\0') {
            ng_plots_destroy(&l->plots, ng_plots_current(&l->plots)->type);
        } else if (!ng_plots_destroy(&l->plots, word)) {
            ng_talk_warn(&l->talk, "destroy: there is no plot '%s'", word);
        }
    } while (next_word(&rest, word, sizeof word)[0] != '\0');
    return ng_lend_vectors(l);
}

static enum dalcs_status unlet(struct ng_library *l, const char *rest) {
    char word[NG_NAME_SIZE];
    DALCS_TRY(ng_take_vectors(l));
    while (next_word(&rest, word, sizeof word)[0] != '\0') {
        if (!ng_plots_unlet(&l->plots, ng_plots_current(&l->plots), word)) {
            ng_talk_fail(&l->talk, "unlet: there is no vector '%s'", word);
            return fail(l);
        }
    }
    return ng_lend_vectors(l);
}

static enum dalcs_status display(struct ng_library *l, const char *rest) {
    static const char *const type[] = {
        [DALCS_VOLT] = "voltage",        [DALCS_AMPERE] = "current",
        [DALCS_UNIT_SECOND] = "time",    [DALCS_UNIT_HERTZ] = "frequency",
        [DALCS_UNIT_OHM] = "resistance", [DALCS_UNIT_NONE] = "notype"};
    (void)rest;
    DALCS_TRY(ng_take_vectors(l));
    const struct ng_plot *plot = ng_plots_current(&l->plots);
    fprintf(l->talk.out, "Here are the vectors currently active:\nTitle: %s\nName: %s (%s)\n",
            plot->title, plot->type, plot->kind);
    for (size_t k = 0; k < plot->n; k++) {
        const struct ng_vector *v = plot->vector[k];
        fprintf(l->talk.out, "    %-20s: %s, %s, %zu long%s\n", v->name, type[v->unit],
                v->is_complex ? "complex" : "real", v->n,
                plot->has_scale && k == 0 ? " [default scale]" : "");
    }
    return DALCS_OK;
}

/* ---- The circuit and the simulator ------------------------------------------------------------------ */

static enum dalcs_status listing(struct ng_library *l, const char *rest) {
    int number = 0;
    (void)rest;
    if (l->circuit->is_none) {
        ng_talk_fail(&l->talk, "listing: there is no circuit");
        return fail(l);
    }
    for (const char *line = l->circuit->source.text; *line != '\0'; line += *line == '\n') {
        const size_t n = strcspn(line, "\n");
        fprintf(l->talk.out, "%6d : %.*s\n", ++number, (int)n, line);
        line += n;
    }
    return DALCS_OK;
}

/* PySpice reads the number of ngspice, whose interface this is, from the first line. */
static enum dalcs_status version(struct ng_library *l, const char *rest) {
    (void)rest;
    fprintf(l->talk.out,
            "** ngspice-39, for programs that look for it: this is dalcs %s\n"
            "** with ideal diodes and switches, and without transistor amplifiers\n",
            dalcs_version());
    return DALCS_OK;
}

static enum dalcs_status status_of(struct ng_library *l, const char *rest) {
    (void)rest;
    fprintf(l->talk.out, "%s, %zu plot%s\n", l->circuit->is_none ? "no circuit" : l->circuit->name,
            l->plots.n, l->plots.n == 1 ? "" : "s");
    return DALCS_OK;
}

static enum dalcs_status rusage(struct ng_library *l, const char *rest) {
    (void)rest;
    const struct dalcs_report *report = dalcs_session_report(l->circuit->session);
    fprintf(l->talk.out, "Total elapsed time (seconds) = %.6g\n", (double)clock() / CLOCKS_PER_SEC);
    if (report != NULL) {
        fprintf(l->talk.out, "Last run: %ld steps, %.6g s\n", report->work.steps,
                report->work.wall_s);
    }
    return DALCS_OK;
}

/* They load or shape what is not here, and change no result. */
static enum dalcs_status nothing(struct ng_library *l, const char *rest) {
    (void)l;
    (void)rest;
    return DALCS_OK;
}

static const struct {
    const char *word;
    enum dalcs_status (*function)(struct ng_library *l, const char *rest);
} COMMAND[] = {{"setplot", setplot},  {"destroy", destroy}, {"unlet", unlet},
               {"display", display},  {"listing", listing}, {"version", version},
               {"status", status_of}, {"rusage", rusage},   {"codemodel", nothing},
               {"esave", nothing},    {"delete", nothing},  {"setcirc", nothing}};

enum { N_COMMANDS = sizeof COMMAND / sizeof COMMAND[0] };

bool ng_commands_know(void *user, const char *word) {
    bool known = false;
    (void)user;
    for (int k = 0; k < N_COMMANDS && !known; k++) {
        known = strcmp(COMMAND[k].word, word) == 0;
    }
    return known;
}

enum dalcs_status ng_commands_execute(void *user, const char *word, const char *rest) {
    for (int k = 0; k < N_COMMANDS; k++) {
        if (strcmp(COMMAND[k].word, word) == 0) {
            return COMMAND[k].function(user, rest);
        }
    }
    return DALCS_OK;
}
