/* execute.c - a command or a block is added to the session's script and executed there. */
#include "library.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- Circuits ---------------------------------------------------------------------------------------- */

static void use_circuit(struct ng_library *l, struct ng_circuit *circuit) {
    ng_circuit_destroy(l->circuit);
    l->circuit = circuit;
    l->has_waiting = false;
    l->host.session = circuit->session;
    l->host.lacks_circuit = circuit->is_none;
    if (l->script != NULL) {
        dalcs_script_change_circuit(l->script);
    }
}

bool ng_forget_circuit(struct ng_library *l) {
    struct ng_circuit *none;
    const enum dalcs_status status = ng_circuit_read(&none, "no circuit", NULL);
    if (status != DALCS_OK) {
        ng_circuit_destroy(none);
        ng_talk_fail(&l->talk, "%s", dalcs_status_text(status));
        return false;
    }
    none->n_told = dalcs_session_n_messages(none->session);
    use_circuit(l, none);
    return true;
}

static enum dalcs_status hear(void *user, const char *word, const char *rest) {
    struct ng_library *l = user;
    if (strcmp(word, "set") == 0) {
        return ng_commands_hear_set(l, rest);
    }
    static const char *const plots[] = {"linearize", "fft", "psd", "spec"};
    DALCS_TRY(ng_take_vectors(l)); /* what was made belongs to the plot before the run */
    for (size_t k = 0; k < sizeof plots / sizeof plots[0]; k++) {
        if (strcmp(word, plots[k]) == 0) {
            return DALCS_OK; /* no run is another one for it */
        }
    }
    return ng_circuit_hear(l->circuit, word, rest);
}

static enum dalcs_status open_script(struct ng_library *l) {
    l->options = dalcs_run_options_default();
    l->host.options = &l->options;
    l->host.sink = &l->sink;
    l->host.out = l->talk.out;
    l->host.user = l;
    l->host.knows = ng_commands_know;
    l->host.execute = ng_commands_execute;
    l->host.measure = ng_measure;
    l->host.heard = hear;
    l->host.made = ng_take_plot;
    l->host.name_of_plot = ng_name_of_plot;
    ng_receive_open(l);
    return dalcs_script_open(&l->script, &l->host);
}

enum dalcs_status ng_library_open(struct ng_library *l) {
    if (l->is_open) { /* a reset that found no memory has left it without a script */
        return open_script(l);
    }
    DALCS_TRY(ng_talk_open(&l->talk));
    DALCS_TRY(ng_plots_open(&l->plots));
    DALCS_TRY(ng_background_open(&l->background));
    l->is_open = true;
    if (!ng_forget_circuit(l)) {
        return DALCS_E_NOMEM;
    }
    return open_script(l);
}

void ng_library_close(struct ng_library *l) {
    if (!l->is_open || !ng_background_close(&l->background)) {
        return; /* what a thread still uses stays */
    }
    dalcs_script_close(l->script);
    ng_circuit_destroy(l->circuit);
    ng_lines_finish(&l->by_line);
    ng_plots_close(&l->plots);
    ng_receive_close(l);
    free(l->input_path);
    ng_talk_close(&l->talk);
    l->script = NULL; /* a later call opens all of it again */
    l->circuit = NULL;
    l->input_path = NULL;
    l->is_open = false;
}

bool ng_forget_all(struct ng_library *l) {
    ng_plots_destroy_all(&l->plots);
    ng_lines_finish(&l->by_line);
    dalcs_script_close(l->script);
    l->script = NULL;
    return ng_forget_circuit(l) && open_script(l) == DALCS_OK;
}

/* ---- Execution ---------------------------------------------------------------------------------------- */

static void quit(struct ng_library *l) {
    (void)ng_forget_all(l);
    ng_controlled_exit *leave = l->tell.exit;
    if (leave != NULL) {
        leave(0, false, true, l->talk.id, l->talk.user);
    }
}

/* Lines `first` to `end` - 1 of the session's script. */
static bool execute_lines(struct ng_library *l, size_t first, size_t end, bool is_strict) {
    bool quits = false;
    l->host.is_strict = is_strict;
    l->fails = false;
    enum dalcs_status status = dalcs_script_read(l->script, first, end);
    status = status == DALCS_OK ? ng_lend_vectors(l) : status;
    if (status == DALCS_OK) {
        status = dalcs_script_execute(l->script, &quits);
        const enum dalcs_status taken = ng_take_vectors(l);
        status = status == DALCS_OK ? taken : status;
    }
    fflush(l->talk.out);
    const size_t n_errors = ng_talk_messages(&l->talk, l->circuit->session, &l->circuit->n_told);
    if (status == DALCS_E_CANCELLED) {
        ng_talk_say(&l->talk, "Note: the run ended early; its rows so far are kept");
    } else if (status != DALCS_OK && n_errors == 0 && !l->fails) {
        ng_talk_fail(&l->talk, "%s", dalcs_status_text(status));
    }
    if (quits) {
        quit(l);
    }
    return status == DALCS_OK || status == DALCS_E_CANCELLED;
}

/* Where a command ends: at a `;` outside of quotes. */
static size_t length_of(const char *commands) {
    bool quoted = false;
    size_t n = 0;
    while (commands[n] != '\0' && (quoted || commands[n] != ';')) {
        quoted = commands[n] == '"' ? !quoted : quoted;
        n++;
    }
    return n;
}

static bool execute_one(struct ng_library *l, const char *command) {
    struct dalcs_session *session = l->circuit->session;
    const size_t first = dalcs_session_n_script_lines(session);
    if (command[strspn(command, " \t\r\n")] == '\0') {
        return true;
    }
    const enum dalcs_status status = dalcs_session_add_script_line(session, command);
    if (status != DALCS_OK) {
        ng_talk_fail(&l->talk, "%s", dalcs_status_text(status));
        return false;
    }
    return execute_lines(l, first, first + 1, true);
}

bool ng_execute(struct ng_library *l, const char *commands) {
    char *copy = dalcs_alloc(strlen(commands) + 1, 1);
    bool went_well = copy != NULL;
    while (went_well) { /* ends below */
        const size_t n = length_of(commands);
        memcpy(copy, commands, n);
        copy[n] = '\0';
        for (char *c = copy; *c != '\0'; c++) {
            *c = *c == '\n' || *c == '\r' ? ' ' : *c;
        }
        went_well = execute_one(l, copy);
        if (commands[n] == '\0') {
            break;
        }
        commands += n + 1;
    }
    free(copy);
    return went_well;
}

void ng_execute_waiting(struct ng_library *l) {
    if (l->has_waiting) {
        l->has_waiting = false;
        (void)execute_lines(l, 0, l->circuit->n_control, false);
    }
}

bool ng_execute_circuit(struct ng_library *l, const char *name, const char *text) {
    if (ng_circuit_is_empty(text)) {
        return ng_forget_circuit(l);
    }
    struct ng_circuit *circuit;
    const enum dalcs_status status = ng_circuit_read(&circuit, name, text);
    size_t n_errors = 0;
    if (circuit != NULL && circuit->session != NULL) {
        n_errors = ng_talk_messages(&l->talk, circuit->session, &circuit->n_told);
    }
    if (status != DALCS_OK) {
        if (n_errors == 0) {
            ng_talk_fail(&l->talk, "%s", dalcs_status_text(status));
        }
        ng_circuit_destroy(circuit);
        (void)ng_forget_circuit(l);
        return false;
    }
    use_circuit(l, circuit);
    static const char word[] = ".title ";
    const char *title = text + (strncasecmp(text, word, strlen(word)) == 0 ? strlen(word) : 0);
    ng_talk_say(&l->talk, "Circuit: %.*s", (int)strcspn(title, "\r\n"), title);
    if (circuit->n_control == 0) {
        return true;
    }
    l->has_waiting = dalcs_script_variable(l->script, "controlswait") != NULL;
    return l->has_waiting || execute_lines(l, 0, circuit->n_control, false);
}
