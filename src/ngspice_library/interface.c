/* interface.c - what programs call. Nothing here ends the process, touches its signals or its locale. */
#include "library.h"

#include "diag.h"
#include "lower_case.h"
#include "text_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The interface has no handle: a process has one simulator. */
static struct ng_library the;

static bool is_ready(void) {
    if (!the.is_open && ng_library_open(&the) != DALCS_OK) {
        ng_library_close(&the);
        return false;
    }
    return true;
}

__attribute__((destructor)) static void leave(void) {
    if (the.is_open && !ng_background_is_here(&the.background)) {
        the.talk.send_char = NULL; /* the program's functions may be gone */
        the.tell = (struct ng_callbacks){0};
        the.background.tell = NULL;
        ng_library_close(&the);
    }
}

int ngSpice_Init(ng_send_char *send_char, ng_send_status *send_status,
                 ng_controlled_exit *controlled_exit, ng_send_data *send_data,
                 ng_send_init_data *send_init_data, ng_thread_state *thread_state, void *user) {
    the.talk.send_char = send_char;
    the.talk.user = user;
    the.tell = (struct ng_callbacks){send_status, controlled_exit, send_data, send_init_data};
    the.background.tell = thread_state;
    the.background.user = user;
    if (!is_ready()) {
        return 1;
    }
    ng_receive_open(&the);
    ng_talk_say(&the.talk, "******");
    ng_talk_say(&the.talk, "** ngspice-39 is what programs may take this for: it is dalcs %s",
                dalcs_version());
    ng_talk_say(&the.talk, "******");
    return 0;
}

int ngSpice_Init_Sync(void *voltage, void *current, void *step, int *id, void *user) {
    (void)voltage;
    (void)current;
    (void)step;
    if (id != NULL) {
        the.talk.id = the.background.id = *id;
    }
    if (user != NULL) {
        the.talk.user = the.background.user = user;
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

/* May something be executed now? What was halted ends. */
static bool is_free(const char *command) {
    if (ng_background_is_running(&the.background)) {
        ng_talk_warn(&the.talk, "cannot execute \"%.200s\", type \"bg_halt\" first", command);
        return false;
    }
    if (ng_background_is_halted(&the.background)) {
        ng_talk_say(&the.talk, "Note: the run that was halted ends here");
    }
    ng_background_end(&the.background);
    if (the.is_busy) { /* one of its own callbacks asks */
        ng_talk_warn(&the.talk, "cannot execute \"%.200s\" while another command runs", command);
        return false;
    }
    return true;
}

static bool load(const char *text) {
    const char *folder = the.input_path != NULL ? the.input_path : ".";
    const size_t n = strlen(folder);
    char *name = dalcs_alloc(n + sizeof "/circuit", 1);
    if (name == NULL) {
        return false;
    }
    const bool is_here = the.input_path == NULL;
    snprintf(name, n + sizeof "/circuit", "%s%s%s", is_here ? "" : folder,
             is_here || folder[n > 0 ? n - 1 : 0] == '/' ? "" : "/", "circuit");
    const bool went_well = ng_execute_circuit(&the, name, text);
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
        went_well = ng_execute_circuit(&the, copy, text);
    } else {
        ng_talk_fail(&the.talk, "source: cannot read '%s'", copy);
    }
    free(text);
    free(copy);
    dalcs_diag_finish(&diag);
    return went_well;
}

/* The circuit is there when its .end comes. */
static bool add_line(const char *line) {
    bool went_well = ng_lines_add(&the.by_line, line) == DALCS_OK;
    const char *unused;
    if (went_well && is_word(line, ".end", &unused)) {
        struct ng_lines lines = the.by_line;
        the.by_line = (struct ng_lines){0};
        went_well = load(lines.text);
        ng_lines_finish(&lines);
    }
    return went_well;
}

/* In the background's thread. */
static void work(void *argument, const char *command) {
    struct ng_library *l = argument;
    if (!ng_execute(l, command)) {
        ng_talk_fail(&l->talk, "%s: simulation run aborted", command);
    }
    ng_execute_waiting(l);
}

static int start(const char *command) {
    const enum dalcs_status status = ng_background_start(&the.background, work, &the, command);
    if (status != DALCS_OK) {
        ng_talk_fail(&the.talk, "bg_%s: %s", command, dalcs_status_text(status));
    }
    return status != DALCS_OK;
}

static bool execute(const char *command) {
    const char *rest;
    the.is_busy = true;
    bool went_well;
    if (is_word(command, "source", &rest)) {
        went_well = source(rest);
    } else if (is_word(command, "circbyline", &rest)) {
        went_well = add_line(rest);
    } else if (is_word(command, "remcirc", &rest)) {
        went_well = ng_forget_circuit(&the);
    } else {
        went_well = ng_execute(&the, command);
    }
    the.is_busy = false;
    return went_well;
}

int ngSpice_Command(char *command) {
    const char *rest;
    if (command == NULL) { /* PySpice frees ngspice's history so */
        return 0;
    }
    if (!is_ready()) {
        return 1;
    }
    const char *begin = command + strspn(command, " \t\r\n");
    if (is_word(begin, "bg_halt", &rest)) {
        if (!ng_background_halt(&the.background)) {
            ng_talk_say(&the.talk, "Note: bg_halt: nothing runs in the background");
        }
        return 0;
    }
    if (is_word(begin, "bg_resume", &rest) || is_word(begin, "resume", &rest)) {
        const bool waits = begin[0] == 'r' || begin[0] == 'R';
        if (!ng_background_resume(&the.background)) {
            ng_talk_say(&the.talk, "Note: resume: nothing was halted");
        } else if (waits) {
            ng_background_end(&the.background);
        }
        return 0;
    }
    if (!is_free(begin)) {
        return 0;
    }
    if (strncasecmp(begin, "bg_", 3) == 0) {
        return start(begin + 3);
    }
    return execute(begin) ? 0 : 1;
}

int ngSpice_Circ(char **line) {
    struct ng_lines text = {0};
    bool went_well = is_ready() && line != NULL;
    const char *unused;
    if (!went_well) {
        return 1;
    }
    if (!is_free("a new circuit")) {
        return 1;
    }
    for (size_t k = 0; went_well && line[k] != NULL; k++) {
        const char *begin = line[k] + strspn(line[k], " \t");
        went_well = ng_lines_add(&text, line[k]) == DALCS_OK;
        if (k > 0 && is_word(begin, ".end", &unused)) {
            break;
        }
    }
    the.is_busy = true;
    went_well = went_well && load(text.text != NULL ? text.text : "");
    the.is_busy = false;
    ng_lines_finish(&text);
    return went_well ? 0 : 1;
}

/* ---- Results ---------------------------------------------------------------------------------------- */

struct ng_vector_info *ngGet_Vec_Info(char *name) {
    static const int type[] = {[DALCS_VOLT] = NG_TYPE_VOLTAGE,
                               [DALCS_AMPERE] = NG_TYPE_CURRENT,
                               [DALCS_UNIT_SECOND] = NG_TYPE_TIME,
                               [DALCS_UNIT_HERTZ] = NG_TYPE_FREQUENCY,
                               [DALCS_UNIT_OHM] = NG_TYPE_NONE,
                               [DALCS_UNIT_NONE] = NG_TYPE_NONE};
    if (name == NULL || !is_ready()) {
        return NULL;
    }
    pthread_mutex_lock(&the.plots.lock);
    const struct ng_vector *v = ng_plots_vector(&the.plots, name);
    if (v != NULL) {
        double *value = v->block->value;
        the.plots.info = (struct ng_vector_info){
            .name = v->name,
            .type = type[v->unit],
            .flags = (short)((v->is_complex ? NG_FLAG_COMPLEX : NG_FLAG_REAL) | NG_FLAG_PERMANENT),
            .real = v->is_complex ? NULL : value,
            .pairs = v->is_complex ? (struct ng_complex *)(void *)value : NULL,
            .length = (int)v->n};
    }
    pthread_mutex_unlock(&the.plots.lock);
    return v != NULL ? &the.plots.info : NULL;
}

char *ngSpice_CurPlot(void) {
    static char none[] = "const";
    if (!is_ready()) {
        return none;
    }
    pthread_mutex_lock(&the.plots.lock);
    char *type = ng_plots_current(&the.plots)->type;
    pthread_mutex_unlock(&the.plots.lock);
    return type;
}

/* Room for a list that lives until the next one. NULL: no memory. */
static char **begin_list(size_t n) {
    free(the.plots.name);
    the.plots.name = dalcs_alloc(n + 1, sizeof(char *));
    return the.plots.name;
}

char **ngSpice_AllPlots(void) {
    static char *none[] = {NULL};
    if (!is_ready()) {
        return none;
    }
    pthread_mutex_lock(&the.plots.lock);
    const size_t n = the.plots.n;
    char **list = begin_list(n);
    for (size_t k = 0; list != NULL && k < n; k++) {
        list[k] = the.plots.plot[n - 1 - k]->type; /* the newest first */
    }
    pthread_mutex_unlock(&the.plots.lock);
    return list != NULL ? list : none;
}

char **ngSpice_AllVecs(char *name) {
    if (name == NULL || !is_ready()) {
        return NULL;
    }
    pthread_mutex_lock(&the.plots.lock);
    const struct ng_plot *plot = ng_plots_find(&the.plots, name);
    char **list = plot != NULL ? begin_list(plot->n) : NULL;
    for (size_t k = 0; list != NULL && k < plot->n; k++) {
        list[k] = plot->vector[plot->n - 1 - k]->name; /* the scale last, as ngspice lists them */
    }
    pthread_mutex_unlock(&the.plots.lock);
    return list;
}

bool ngSpice_running(void) {
    return the.is_open && ng_background_is_running(&the.background);
}

/* Events and edges are found wherever they lie: no step needs to end at a time that is given. */
bool ngSpice_SetBkpt(double time) {
    (void)time;
    return the.is_open && !the.circuit->is_none;
}

char *ngCM_Input_Path(const char *path) {
    if (path != NULL) {
        char *copy = dalcs_alloc(strlen(path) + 1, 1);
        if (copy != NULL) {
            strcpy(copy, path);
            free(the.input_path);
            the.input_path = copy;
        }
    }
    return the.input_path;
}

/* ---- What programs find in newer versions, and what is not here ---------------------------------------- */

int ngSpice_LockRealloc(void) {
    return is_ready() ? pthread_mutex_lock(&the.plots.lock) : 1;
}

int ngSpice_UnlockRealloc(void) {
    return is_ready() ? pthread_mutex_unlock(&the.plots.lock) : 1;
}

/* No file is read but the netlists that are named. */
int ngSpice_nospinit(void) {
    return 0;
}

int ngSpice_nospiceinit(void) {
    return 0;
}

int ngSpice_Reset(void) {
    if (!is_ready() || !is_free("reset")) {
        return 1;
    }
    return ng_forget_all(&the) ? 0 : 1;
}

/* Digital nodes carry voltages here: there are no event nodes. */
char **ngSpice_AllEvtNodes(void) {
    static char *none[] = {NULL};
    return none;
}

void *ngGet_Evt_NodeInfo(char *node) {
    (void)node;
    return NULL;
}

int ngSpice_Init_Evt(void *data, void *init_data, void *user) {
    (void)data;
    (void)init_data;
    (void)user;
    return 0;
}

int ngSpice_Raw_Evt(char *node, void *data, void *init_data, void *user) {
    (void)node;
    (void)data;
    (void)init_data;
    (void)user;
    return 1;
}

int ngSpice_Decode_Evt(void *node, int type, double *value, const char **name) {
    (void)node;
    (void)type;
    (void)value;
    (void)name;
    return 1;
}
