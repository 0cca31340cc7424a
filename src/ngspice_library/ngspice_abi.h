/* ngspice_abi.h - the functions of libngspice.so.0 and the layout of what they exchange.
 *
 * Programs that were built for ngspice's shared library call these. The layout is theirs: a change here
 * breaks them. Names of fields are dalcs's own. */
#ifndef DALCS_NGSPICE_ABI_H
#define DALCS_NGSPICE_ABI_H

#include <stdbool.h>

#pragma GCC visibility push(default) /* all else in the library is hidden */

struct ng_complex {
    double re, im;
};

/* Of one vector; a bit of `flags` says in which of the two its values are. */
struct ng_vector_info {
    char *name;
    int type;
    short flags;
    double *real;
    struct ng_complex *pairs;
    int length;
};

enum { NG_TYPE_NONE, NG_TYPE_TIME, NG_TYPE_FREQUENCY, NG_TYPE_VOLTAGE, NG_TYPE_CURRENT };

enum { NG_FLAG_REAL = 1, NG_FLAG_COMPLEX = 2, NG_FLAG_PERMANENT = 128 };

/* A row of all vectors, for SendData. */
struct ng_value {
    char *name;
    double re, im;
    bool is_scale, is_complex;
};

struct ng_row {
    int n, index; /* vectors, rows so far */
    struct ng_value **value;
};

/* All vectors of a new plot, for SendInitData. */
struct ng_announced {
    int number;
    char *name;
    bool is_real;
    void *vector, *scale;
};

struct ng_announcement {
    char *name, *title, *date, *type; /* "Transient Analysis", the title line, ..., "tran1" */
    int n;
    struct ng_announced **vector;
};

/* Each ends with the number from ngSpice_Init_Sync and the pointer from ngSpice_Init. */
typedef int ng_send_char(char *line, int id, void *user);
typedef int ng_send_status(char *text, int id, void *user);
typedef int ng_controlled_exit(int status, bool at_once, bool by_quit, int id, void *user);
typedef int ng_send_data(struct ng_row *row, int n, int id, void *user);
typedef int ng_send_init_data(struct ng_announcement *plot, int id, void *user);
typedef int ng_thread_state(bool is_not_running, int id, void *user);

int ngSpice_Init(ng_send_char *send_char, ng_send_status *send_status,
                 ng_controlled_exit *controlled_exit, ng_send_data *send_data,
                 ng_send_init_data *send_init_data, ng_thread_state *thread_state, void *user);
/* The first three would give values of external sources and time steps: they are never asked. */
int ngSpice_Init_Sync(void *voltage, void *current, void *step, int *id, void *user);
int ngSpice_Init_Evt(void *data, void *init_data, void *user);
int ngSpice_Command(char *command);
int ngSpice_Circ(char **line);
struct ng_vector_info *ngGet_Vec_Info(char *name);
char *ngSpice_CurPlot(void);
char **ngSpice_AllPlots(void);
char **ngSpice_AllVecs(char *plot);
bool ngSpice_running(void);
bool ngSpice_SetBkpt(double time);
char *ngCM_Input_Path(const char *path);
void *ngGet_Evt_NodeInfo(char *node);
char **ngSpice_AllEvtNodes(void);
int ngSpice_nospinit(void);
int ngSpice_nospiceinit(void);
int ngSpice_LockRealloc(void);
int ngSpice_UnlockRealloc(void);
int ngSpice_Reset(void);
int ngSpice_Raw_Evt(char *node, void *data, void *init_data, void *user);
int ngSpice_Decode_Evt(void *node, int type, double *value, const char **name);

#pragma GCC visibility pop

_Static_assert(sizeof(struct ng_vector_info) == 40 && sizeof(struct ng_value) == 32 &&
                   sizeof(struct ng_row) == 16 && sizeof(struct ng_announced) == 40 &&
                   sizeof(struct ng_announcement) == 48,
               "the layout of ngspice's interface, 64 bits");

#endif
