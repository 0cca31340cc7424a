/* results.c - gives programs the vectors of a plot. */
#include "library.h"

#include <stdlib.h>
#include <string.h>

struct ng_vector_info *ngGet_Vec_Info(char *name) {
    static const int type[] = {
        [DALCS_VOLT] = NG_TYPE_VOLTAGE,     [DALCS_AMPERE] = NG_TYPE_CURRENT,
        [DALCS_UNIT_SECOND] = NG_TYPE_TIME, [DALCS_UNIT_HERTZ] = NG_TYPE_FREQUENCY,
        [DALCS_UNIT_OHM] = NG_TYPE_NONE,    [DALCS_UNIT_NONE] = NG_TYPE_NONE};
    if (name == NULL || !ng_is_ready()) {
        return NULL;
    }
    pthread_mutex_lock(&ng_the.plots.lock);
    const struct ng_vector *v = ng_plots_vector(&ng_the.plots, name);
    if (v != NULL) {
        double *value = v->block->value;
        ng_the.plots.info = (struct ng_vector_info){
            .name = v->name,
            .type = type[v->unit],
            .flags = (short)((v->is_complex ? NG_FLAG_COMPLEX : NG_FLAG_REAL) | NG_FLAG_PERMANENT),
            .real = v->is_complex ? NULL : value,
            .pairs = v->is_complex ? (struct ng_complex *)(void *)value : NULL,
            .length = (int)v->n};
    }
    pthread_mutex_unlock(&ng_the.plots.lock);
    return v != NULL ? &ng_the.plots.info : NULL;
}

char *ngSpice_CurPlot(void) {
    static char none[] = "const";
    if (!ng_is_ready()) {
        return none;
    }
    pthread_mutex_lock(&ng_the.plots.lock);
    char *type = ng_plots_current(&ng_the.plots)->type;
    pthread_mutex_unlock(&ng_the.plots.lock);
    return type;
}

/* Room for a list that lives until the next one. NULL: no memory. */
static char **begin_list(size_t n) {
    free(ng_the.plots.name);
    ng_the.plots.name = dalcs_alloc(n + 1, sizeof(char *));
    return ng_the.plots.name;
}

char **ngSpice_AllPlots(void) {
    static char *none[] = {NULL};
    if (!ng_is_ready()) {
        return none;
    }
    pthread_mutex_lock(&ng_the.plots.lock);
    const size_t n = ng_the.plots.n;
    char **list = begin_list(n);
    for (size_t k = 0; list != NULL && k < n; k++) {
        list[k] = ng_the.plots.plot[n - 1 - k]->type; /* the newest first */
    }
    pthread_mutex_unlock(&ng_the.plots.lock);
    return list != NULL ? list : none;
}

char **ngSpice_AllVecs(char *name) {
    if (name == NULL || !ng_is_ready()) {
        return NULL;
    }
    pthread_mutex_lock(&ng_the.plots.lock);
    const struct ng_plot *plot = ng_plots_find(&ng_the.plots, name);
    char **list = plot != NULL ? begin_list(plot->n) : NULL;
    for (size_t k = 0; list != NULL && k < plot->n; k++) {
        list[k] = plot->vector[plot->n - 1 - k]->name; /* the scale last, as ngspice lists them */
    }
    pthread_mutex_unlock(&ng_the.plots.lock);
    return list;
}

bool ngSpice_running(void) {
    return ng_the.is_open && ng_background_is_running(&ng_the.background);
}

/* Events and edges are found wherever they lie: no step needs to end at a time that is given. */
bool ngSpice_SetBkpt(double time) {
    (void)time;
    return ng_the.is_open && !ng_the.circuit->is_none;
}

char *ngCM_Input_Path(const char *path) {
    if (path != NULL) {
        char *copy = dalcs_alloc(strlen(path) + 1, 1);
        if (copy != NULL) {
            strcpy(copy, path);
            free(ng_the.input_path);
            ng_the.input_path = copy;
        }
    }
    return ng_the.input_path;
}

/* ---- What programs find in newer versions, and what is not here ---------------------------------------- */

int ngSpice_LockRealloc(void) {
    return ng_is_ready() ? pthread_mutex_lock(&ng_the.plots.lock) : 1;
}

int ngSpice_UnlockRealloc(void) {
    return ng_is_ready() ? pthread_mutex_unlock(&ng_the.plots.lock) : 1;
}

/* spinit is ngspice's own: it loads what is no part of this. */
int ngSpice_nospinit(void) {
    return 0;
}

int ngSpice_nospiceinit(void) {
    ng_the.reads_no_start_file = true;
    return 0;
}

int ngSpice_Reset(void) {
    if (!ng_is_ready() || !ng_is_free("reset")) {
        return 1;
    }
    return ng_forget_all(&ng_the) ? 0 : 1;
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
