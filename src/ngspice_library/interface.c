/* interface.c - how programs begin and send commands and circuits. Nothing here ends the process, touches its signals or its locale. */
#include "library.h"

#include "diag.h"
#include "lower_case.h"
#include "start_file.h"
#include "text_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct ng_library ng_the;

bool ng_is_ready(void) {
    if ((!ng_the.is_open || ng_the.script == NULL) && ng_library_open(&ng_the) != DALCS_OK) {
        ng_library_close(&ng_the);
        return false;
    }
    return true;
}

__attribute__((destructor)) static void leave(void) {
    if (ng_the.is_open) {
        ng_the.talk.send_char = NULL; /* the program's functions may be gone */
        ng_the.tell.status = NULL;
        ng_the.tell.exit = NULL;
        ng_the.tell.data = NULL;
        ng_the.tell.init_data = NULL;
        ng_the.background.tell = NULL;
        ng_library_close(&ng_the);
    }
}

static void note_left_out(void *user, const struct dalcs_start_file *file, const char *command) {
    (void)user;
    ng_talk_say(&ng_the.talk,
                "Note: %s:%d: '%.60s' is left out: of this file, set and unset are done",
                file->path, file->line, command);
}

/* The variables that the user's .spiceinit sets; a mistake there is told, and hinders nothing. */
static void start_as_told(void) {
    struct dalcs_start_file file = {0};
    if (dalcs_start_file_read(&file) != DALCS_OK) {
        ng_talk_fail(&ng_the.talk, "%s", dalcs_status_text(DALCS_E_NOMEM));
    } else if (file.text != NULL) {
        ng_talk_say(&ng_the.talk, "Note: %s was read, as ngspice does", file.path);
    }
    for (const char *command;
         (command = dalcs_start_file_next(&file, note_left_out, NULL)) != NULL;) {
        (void)ng_execute(&ng_the, command);
    }
    dalcs_start_file_finish(&file);
}

int ngSpice_Init(ng_send_char *send_char, ng_send_status *send_status,
                 ng_controlled_exit *controlled_exit, ng_send_data *send_data,
                 ng_send_init_data *send_init_data, ng_thread_state *thread_state, void *user) {
    ng_the.talk.send_char = send_char;
    ng_the.talk.user = user;
    ng_the.tell.status = send_status;
    ng_the.tell.exit = controlled_exit;
    ng_the.tell.data = send_data;
    ng_the.tell.init_data = send_init_data;
    ng_the.background.tell = thread_state;
    ng_the.background.user = user;
    if (!ng_is_ready()) {
        return 1;
    }
    ng_receive_open(&ng_the);
    ng_talk_say(&ng_the.talk, "******");
    ng_talk_say(&ng_the.talk, "** ngspice-39, for programs that look for it: this is dalcs %s",
                dalcs_version());
    ng_talk_say(&ng_the.talk, "******");
    if (!ng_the.reads_no_start_file) {
        start_as_told();
    }
    return 0;
}

int ngSpice_Init_Sync(void *voltage, void *current, void *step, int *id, void *user) {
    (void)voltage;
    (void)current;
    (void)step;
    if (id != NULL) {
        ng_the.talk.id = ng_the.background.id = *id;
    }
    if (user != NULL) {
        ng_the.talk.user = ng_the.background.user = user;
    }
    return 0;
}

/* ---- Commands and circuits ------------------------------------------------------------------------- */

/* Does the command begin with this word? *rest: what follows. */
static bool is_word(const char *command, const char *word, const char **rest) {
    const size_t n = strlen(word);
    const bool is = strncasecmp(command, word, n) == 0 && strchr(" \t\r\n", command[n]) != NULL;
    if (is) {
        *rest = command + n + strspn(command + n, " \t\r\n");
    }
    return is;
}

bool ng_is_free(const char *command) {
    if (ng_background_is_running(&ng_the.background)) {
        ng_talk_warn(&ng_the.talk, "cannot execute \"%.200s\", type \"bg_halt\" first", command);
        return false;
    }
    if (ng_background_is_halted(&ng_the.background)) {
        ng_talk_say(&ng_the.talk, "Note: the run that was halted ends here");
    }
    ng_background_end(&ng_the.background);
    if (ng_the.is_busy) { /* called by one of its own callbacks */
        ng_talk_warn(&ng_the.talk, "cannot execute \"%.200s\" while another command runs", command);
        return false;
    }
    return true;
}

static bool load(const char *text) {
    const char *folder = ng_the.input_path != NULL ? ng_the.input_path : ".";
    const size_t n = strlen(folder);
    char *name = dalcs_alloc(n + sizeof "/circuit", 1);
    if (name == NULL) {
        return false;
    }
    const bool is_here = ng_the.input_path == NULL;
    snprintf(name, n + sizeof "/circuit", "%s%s%s", is_here ? "" : folder,
             is_here || folder[n > 0 ? n - 1 : 0] == '/' ? "" : "/", "circuit");
    const bool went_well = ng_execute_circuit(&ng_the, name, text);
    free(name);
    return went_well;
}

static bool source(const char *path) {
    struct dalcs_diag diag = {0};
    char *copy = dalcs_alloc(strlen(path) + 1, 1);
    char *text = NULL;
    size_t length;
    if (copy == NULL) {
        return false;
    }
    strcpy(copy, path + (path[0] == '"'));
    copy[strcspn(copy, path[0] == '"' ? "\"" : "\r\n")] = '\0';
    bool went_well = dalcs_text_file_read(copy, INT_MAX, &text, &length, NULL, &diag) == DALCS_OK;
    if (went_well) {
        went_well = ng_execute_circuit(&ng_the, copy, text);
    } else {
        ng_talk_fail(&ng_the.talk, "source: cannot read '%s'", copy);
    }
    free(text);
    free(copy);
    dalcs_diag_finish(&diag);
    return went_well;
}

/* The circuit is there when its .end comes. */
static bool add_line(const char *line) {
    bool went_well = ng_lines_add(&ng_the.by_line, line) == DALCS_OK;
    const char *unused;
    if (went_well && is_word(line, ".end", &unused)) {
        struct ng_lines lines = ng_the.by_line;
        ng_the.by_line = (struct ng_lines){0};
        went_well = load(lines.text);
        ng_lines_finish(&lines);
    }
    return went_well;
}

/* In the background's thread. */
static void work(void *argument, const char *command) {
    struct ng_library *l = argument;
    l->plots.is_shared = true;
    if (!ng_execute(l, command)) {
        ng_talk_fail(&l->talk, "%s: simulation run aborted", command);
    }
    ng_execute_waiting(l);
    l->plots.is_shared = false;
}

static int start(const char *command) {
    const enum dalcs_status status =
        ng_background_start(&ng_the.background, work, &ng_the, command);
    if (status != DALCS_OK) {
        ng_talk_fail(&ng_the.talk, "bg_%s: %s", command, dalcs_status_text(status));
    }
    return status != DALCS_OK;
}

static bool execute(const char *command) {
    const char *rest;
    ng_the.is_busy = true;
    bool went_well;
    if (is_word(command, "source", &rest)) {
        went_well = source(rest);
    } else if (is_word(command, "circbyline", &rest)) {
        went_well = add_line(rest);
    } else if (is_word(command, "remcirc", &rest)) {
        went_well = ng_forget_circuit(&ng_the);
    } else {
        went_well = ng_execute(&ng_the, command);
    }
    ng_the.is_busy = false;
    return went_well;
}

int ngSpice_Command(char *command) {
    const char *rest;
    if (command == NULL) { /* PySpice frees ngspice's history so */
        return 0;
    }
    if (!ng_is_ready()) {
        return 1;
    }
    const char *begin = command + strspn(command, " \t\r\n");
    if (is_word(begin, "bg_halt", &rest)) {
        if (!ng_background_halt(&ng_the.background)) {
            ng_talk_say(&ng_the.talk, "Note: bg_halt: nothing runs in the background");
        }
        return 0;
    }
    if (is_word(begin, "bg_resume", &rest) || is_word(begin, "resume", &rest)) {
        const bool waits = begin[0] == 'r' || begin[0] == 'R';
        if (!ng_background_resume(&ng_the.background)) {
            ng_talk_say(&ng_the.talk, "Note: resume: nothing was halted");
        } else if (waits) {
            ng_background_end(&ng_the.background);
        }
        return 0;
    }
    if (!ng_is_free(begin)) {
        return 0;
    }
    if (strncasecmp(begin, "bg_", 3) == 0) {
        return start(begin + 3);
    }
    return execute(begin) ? 0 : 1;
}

int ngSpice_Circ(char **line) {
    struct ng_lines text = {0};
    bool went_well = ng_is_ready() && line != NULL;
    const char *unused;
    if (!went_well) {
        return 1;
    }
    if (!ng_is_free("a new circuit")) {
        return 1;
    }
    for (size_t k = 0; went_well && line[k] != NULL; k++) {
        const char *begin = line[k] + strspn(line[k], " \t");
        went_well = ng_lines_add(&text, line[k]) == DALCS_OK;
        if (k > 0 && is_word(begin, ".end", &unused)) {
            break;
        }
    }
    ng_the.is_busy = true;
    went_well = went_well && load(text.text != NULL ? text.text : "");
    ng_the.is_busy = false;
    ng_lines_finish(&text);
    return went_well ? 0 : 1;
}
