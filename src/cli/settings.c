/* settings.c - values from the command line in place of the netlist's. */
#include "settings.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

double dalcs_settings_value(const char *text, size_t *name_length) {
    const char *equal = strchr(text, '=');
    double value = NAN;
    *name_length = equal != NULL ? (size_t)(equal - text) : 0;
    if (equal == NULL || dalcs_parse_number(equal + 1, &value) != DALCS_OK) {
        return NAN;
    }
    return value;
}

enum dalcs_status dalcs_settings_check(const struct dalcs_cli *cli, const char *text) {
    size_t length;
    if (!isfinite(dalcs_settings_value(text, &length)) || length == 0) {
        dalcs_cli_error(cli, "--set: '%s' is not NAME=NUMBER; write rload=10 or c1=2.2u", text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

size_t dalcs_settings_threads(const struct dalcs_arguments *arguments) {
    const long here = sysconf(_SC_NPROCESSORS_ONLN);
    return arguments->variants.jobs > 0 ? arguments->variants.jobs : here > 0 ? (size_t)here : 1;
}

enum dalcs_status dalcs_settings_prepare(struct dalcs_session *session,
                                         const struct dalcs_arguments *arguments) {
    if (arguments->n_set > 0) {
        DALCS_TRY(dalcs_session_keep_netlist(session));
    }
    if (!isnan(arguments->variants.seed)) {
        DALCS_TRY(dalcs_session_set_seed(session, arguments->variants.seed));
    }
    return dalcs_session_set_transient(session, arguments->tran.card, arguments->tran.stop);
}

enum dalcs_status dalcs_settings_check_script(const struct dalcs_cli *cli,
                                              const struct dalcs_session *session,
                                              const struct dalcs_arguments *arguments) {
    const size_t n_lines = dalcs_session_n_script_lines(session);
    if (arguments->tran.card == NULL && arguments->tran.stop == NULL) {
        return DALCS_OK;
    }
    for (size_t k = 0; k < n_lines; k++) {
        const char *line = dalcs_session_script_line(session, k);
        line += strspn(line, " \t");
        if (strncasecmp(line, "tran", 4) == 0 && strchr(" \t", line[4]) != NULL) {
            dalcs_cli_error(cli, "%s changes the netlist's .tran, and the .control block has '%s'",
                            arguments->tran.card != NULL ? "--tran" : "--tstop", line);
            return DALCS_E_OPTION;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_settings_apply(struct dalcs_session *session,
                                       const struct dalcs_arguments *arguments) {
    for (size_t k = 0; k < arguments->n_set; k++) {
        size_t length;
        const double value = dalcs_settings_value(arguments->set[k], &length);
        char *name = strndup(arguments->set[k], length);
        if (name == NULL) {
            return DALCS_E_NOMEM;
        }
        const enum dalcs_status status = dalcs_session_set_value(session, name, value);
        free(name);
        DALCS_TRY(status);
    }
    return dalcs_session_apply_values(session);
}
