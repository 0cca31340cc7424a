/* forwarder.c - libngspice.so.0 of a test: notes each call in $FORWARD_LOG and hands it to the library $FORWARD_TO. */
#define _GNU_SOURCE
#include "ngspice_abi.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>

static void *function(const char *name) {
    static void *library;
    if (library == NULL) {
        library = dlopen(getenv("FORWARD_TO"), RTLD_NOW | RTLD_LOCAL);
    }
    void *found = library != NULL ? dlsym(library, name) : NULL;
    if (found == NULL) {
        fprintf(stderr, "forwarder: %s: %s\n", name, dlerror());
        abort();
    }
    return found;
}

/* One line: what was called, a number that came of it, with what. */
static void note(const char *what, double number, const char *with) {
    FILE *log = fopen(getenv("FORWARD_LOG"), "a");
    if (log != NULL) {
        fprintf(log, "%s %.12g %s\n", what, number, with != NULL ? with : "");
        fclose(log);
    }
}

/* The pointer of a function as one of the type of `as`. */
#define REAL(as) ((__typeof__(&as))function(#as))

int ngSpice_Init(ng_send_char *a, ng_send_status *b, ng_controlled_exit *c, ng_send_data *d,
                 ng_send_init_data *e, ng_thread_state *f, void *user) {
    int status = REAL(ngSpice_Init)(a, b, c, d, e, f, user);
    note("init", status, "");
    return status;
}

int ngSpice_Command(char *command) {
    int status = REAL(ngSpice_Command)(command);
    note("command", status, command);
    return status;
}

int ngSpice_Circ(char **line) {
    int n = 0;
    while (line != NULL && line[n] != NULL) {
        note("line", n, line[n]);
        n++;
    }
    int status = REAL(ngSpice_Circ)(line);
    note("circuit", status, "");
    return status;
}

struct ng_vector_info *ngGet_Vec_Info(char *name) {
    struct ng_vector_info *v = REAL(ngGet_Vec_Info)(name);
    double most = v != NULL && v->length > 0 && v->real != NULL ? v->real[0] : 0.0;
    for (int k = 1; v != NULL && v->real != NULL && k < v->length; k++) {
        most = v->real[k] > most ? v->real[k] : most;
    }
    note(v != NULL ? "vector" : "nothing", most, name);
    return v;
}

char *ngSpice_CurPlot(void) {
    return REAL(ngSpice_CurPlot)();
}

char **ngSpice_AllPlots(void) {
    return REAL(ngSpice_AllPlots)();
}

char **ngSpice_AllVecs(char *plot) {
    return REAL(ngSpice_AllVecs)(plot);
}

bool ngSpice_running(void) {
    return REAL(ngSpice_running)();
}
