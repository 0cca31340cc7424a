/* argument_times.c - options of `dalcs run` and its relatives that are times. */
#include "argument_values.h"

#include "memory.h"
#include "verb.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum dalcs_status dalcs_argument_period(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, const char *text) {
    if (!arguments->steady.is_asked && !arguments->bode.is_asked) {
        dalcs_cli_error(cli, "--period is an option of 'dalcs steady' and 'dalcs bode'");
        return DALCS_E_OPTION;
    }
    return dalcs_verb_take_positive(cli, "--period", text, &arguments->steady.period);
}

/* The options of `dalcs envelope` alone. */
static enum dalcs_status check_envelope(const struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, const char *name) {
    if (!arguments->envelope.is_asked) {
        dalcs_cli_error(cli, "%s is an option of 'dalcs envelope'", name);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_stop(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *text) {
    DALCS_TRY(check_envelope(arguments, cli, "--stop"));
    return dalcs_verb_take_positive(cli, "--stop", text, &arguments->envelope.stop);
}

/* Times between commas, behind those that are there; owned array. */
static enum dalcs_status take_times(const struct dalcs_cli *cli, const char *name, const char *text,
                                    double **list, size_t *n) {
    char time[64];
    double *all = realloc(*list, (*n + strlen(text) + 1) * sizeof *all);
    if (all == NULL) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(DALCS_E_NOMEM));
        return DALCS_E_NOMEM;
    }
    *list = all;
    for (size_t start = 0, length; start <= strlen(text); start += length + 1) {
        double *value = &all[(*n)++];
        length = strcspn(text + start, ",");
        snprintf(time, sizeof time, "%.*s", (int)length, text + start);
        if (dalcs_parse_number(time, value) != DALCS_OK || !(*value >= 0.0)) {
            dalcs_cli_error(cli, "%s: '%s' is no time; write 0,10m,1", name, time);
            return DALCS_E_OPTION;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_show(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *text) {
    DALCS_TRY(check_envelope(arguments, cli, "--show"));
    arguments->envelope.n_show = 0;
    return take_times(cli, "--show", text, &arguments->envelope.show, &arguments->envelope.n_show);
}

enum dalcs_status dalcs_argument_at(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                    const char *text) {
    double first;
    char time[64];
    snprintf(time, sizeof time, "%.*s", (int)strcspn(text, ","), text);
    /* "10.txt" begins like a number */
    if (access(text, F_OK) != 0 && dalcs_parse_number(time, &first) == DALCS_OK) {
        return take_times(cli, "--at", text, &arguments->rows.times, &arguments->rows.n_times);
    }
    if (arguments->rows.at != NULL) {
        dalcs_cli_error(cli, "--at: a second file of times, '%s': put all times into one", text);
        return DALCS_E_OPTION;
    }
    arguments->rows.at = text;
    return DALCS_OK;
}

static enum dalcs_status check_is_run(const struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *name) {
    if (arguments->steady.is_asked || arguments->bode.is_asked || arguments->envelope.is_asked) {
        dalcs_cli_error(cli, "%s is an option of 'dalcs run'%s", name,
                        arguments->envelope.is_asked ? "; 'dalcs envelope' has --stop" : "");
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_tran(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *text) {
    DALCS_TRY(check_is_run(arguments, cli, "--tran"));
    arguments->tran.card = text;
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_tstop(struct dalcs_arguments *arguments,
                                       const struct dalcs_cli *cli, const char *text) {
    double stop;
    DALCS_TRY(check_is_run(arguments, cli, "--tstop"));
    arguments->tran.stop = text;
    return dalcs_verb_take_positive(cli, "--tstop", text, &stop);
}
