/* client.c - a program that uses ngspice's shared library, whichever one it is told to load: it was compiled with
 * Debian's header of ngspice. Reads what to call from stdin, a line each, and prints what came back.
 *
 *     client LIBRARY [talk] [nodata] < sequence
 *
 *     < LINE           a line of the next circuit
 *     circ             send it
 *     ! COMMAND        ngSpice_Command
 *     null             ngSpice_Command(NULL)
 *     plots, current   names of plots
 *     vecs PLOT        its vectors, sorted
 *     vector NAME      its name, type, flags, whether it has values
 *     last NAME        its last value
 *     at NAME PLOT X   its value where the plot's scale is X, on the line between two rows
 *     most NAME        its largest value
 *     running          is there a run in the background?
 *     breakpoint       what ngSpice_SetBkpt answers
 *     wait             until the background's run is over; what it said comes then
 *     begun NAME       until it has made two rows
 *     slow, fast       each row takes 1 ms, or not
 *     threaded A B     read vector A all the time while command B runs in the background
 *     input FOLDER     files that circuits include lie there
 *     counts           what the callbacks were told
 */
#define _GNU_SOURCE
#include <stdbool.h>

#include <ngspice/sharedspice.h>

#include <dlfcn.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_LINES = 1000, SIZE = 4000, NAME = 2 * SIZE + 2 };

static struct {
    int (*init)(SendChar *, SendStat *, ControlledExit *, SendData *, SendInitData *,
                BGThreadRunning *, void *);
    int (*init_sync)(GetVSRCData *, GetISRCData *, GetSyncData *, int *, void *);
    int (*command)(char *);
    int (*circ)(char **);
    pvector_info (*vector)(char *);
    char *(*current)(void);
    char **(*plots)(void);
    char **(*vecs)(char *);
    NG_BOOL (*running)(void);
    NG_BOOL (*set_breakpoint)(double);
    char *(*input_path)(const char *);
} ng;

static struct {
    bool talks;
    atomic_bool slow;
    atomic_long lines, errors, rows, plots, vectors, begun, ended, exits;
    long ended_before; /* when the background began last */
    pthread_t self;
    char from_thread[16 * SIZE]; /* lines that are not from this one, until wait */
} told;

static int on_char(char *line, int id, void *user) {
    (void)id;
    (void)user;
    const bool is_out = strncmp(line, "stdout ", 7) == 0;
    const bool is_error = strncmp(line, "stderr ", 7) == 0;
    if (!is_out && !is_error) {
        printf("bad line: %s\n", line);
    }
    told.lines++;
    told.errors += is_error && strncmp(line + 7, "Warning:", 8) != 0;
    char *kept = told.from_thread;
    const size_t n = strlen(kept);
    if (told.talks && pthread_equal(pthread_self(), told.self)) {
        printf("| %s\n", line);
    } else if (told.talks) {
        snprintf(kept + n, sizeof told.from_thread - n, "| %s\n", line);
    }
    return 0;
}

static int on_status(char *text, int id, void *user) {
    (void)text;
    (void)id;
    (void)user;
    return 0;
}

static int on_exit_asked(int status, NG_BOOL at_once, NG_BOOL by_quit, int id, void *user) {
    (void)status;
    (void)id;
    (void)user;
    told.exits += !at_once && by_quit;
    return 0;
}

static int on_data(pvecvaluesall row, int n, int id, void *user) {
    (void)id;
    (void)user;
    told.rows += n == row->veccount && n > 0 && row->vecsa[n - 1]->name != NULL;
    if (told.slow) {
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    return 0;
}

static int on_init_data(pvecinfoall plot, int id, void *user) {
    (void)id;
    (void)user;
    told.plots++;
    told.vectors += plot->veccount;
    return 0;
}

static int on_thread(NG_BOOL is_not_running, int id, void *user) {
    (void)id;
    (void)user;
    told.begun += !is_not_running;
    told.ended += is_not_running;
    return 0;
}

static void nap(void) {
    nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
}

static int by_text(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static void print_list(const char *what, char **list, bool sorted) {
    size_t n = 0;
    while (list != NULL && list[n] != NULL) {
        n++;
    }
    if (sorted && n > 0) {
        qsort(list, n, sizeof *list, by_text);
    }
    printf("%s%s", what, list == NULL ? " none" : "");
    for (size_t k = 0; k < n; k++) {
        printf(" %s", list[k]);
    }
    printf("\n");
}

static double value_of(const vector_info *v, int k) {
    return v->v_realdata != NULL ? v->v_realdata[k]
                                 : hypot(v->v_compdata[k].cx_real, v->v_compdata[k].cx_imag);
}

static void print_vector(char *name) {
    const vector_info *v = ng.vector(name);
    if (v == NULL) {
        printf("vector %s none\n", name);
        return;
    }
    const bool is_complex = (v->v_flags & 2) != 0;
    printf("vector %s %s type %d %s %s\n", name, v->v_name, v->v_type,
           is_complex ? "complex" : "real", v->v_length > 1 ? "many" : "one");
    if ((is_complex ? (void *)v->v_compdata : (void *)v->v_realdata) == NULL) {
        printf("no values\n");
    }
}

static void print_at(char *name, char *plot, double x) {
    static const char *const scales[] = {"time", "frequency", "v-sweep", "i-sweep"};
    char text[NAME];
    vector_info scale = {0};
    for (size_t k = 0; k < 4 && scale.v_length == 0; k++) {
        snprintf(text, sizeof text, "%s.%s", plot, scales[k]);
        const vector_info *found = ng.vector(text);
        if (found != NULL) {
            scale = *found;
        }
    }
    snprintf(text, sizeof text, "%s.%s", plot, name);
    const vector_info *v = ng.vector(text);
    int k = 1;
    while (k + 1 < scale.v_length && value_of(&scale, k) < x) {
        k++;
    }
    const bool is_inside = k < scale.v_length && x <= value_of(&scale, k);
    if (v == NULL || !is_inside || k >= v->v_length) {
        printf("at %s none\n", name);
        return;
    }
    const double a = value_of(&scale, k - 1);
    const double b = value_of(&scale, k);
    const double part = b > a ? (x - a) / (b - a) : 1.0;
    printf("at %s %.12g = %.12g\n", name, x,
           value_of(v, k - 1) + part * (value_of(v, k) - value_of(v, k - 1)));
}

static void print_value(const char *what, char *name) {
    const vector_info *v = ng.vector(name);
    if (v == NULL || v->v_length == 0) {
        printf("%s %s none\n", what, name);
        return;
    }
    double value = value_of(v, v->v_length - 1);
    for (int k = 0; what[0] == 'm' && k < v->v_length; k++) {
        value = fmax(value, value_of(v, k));
    }
    printf("%s %s = %.12g\n", what, name, value);
}

/* A run in the background while vectors are read, as a program does that draws it. */
static void read_while_running(char *name, char *command) {
    int length = 0;
    long wrong = 0;
    double sum = 0.0;
    told.ended_before = told.ended;
    ng.command(command);
    while (ng.running() || told.ended == told.ended_before) {
        const vector_info *found = ng.vector(name);
        if (found != NULL) {
            const vector_info v = *found;
            wrong += v.v_length < length;
            length = v.v_length;
            for (int k = 0; k < v.v_length; k++) {
                sum += v.v_realdata[k];
            }
        }
    }
    printf("threaded wrong %ld finite %d\n", wrong, isfinite(sum) != 0);
}

/* What another thread said, when it is over. */
static void print_kept(void) {
    fputs(told.from_thread, stdout);
    told.from_thread[0] = '\0';
}

static void execute(char *line, char **circuit, int *n_lines) {
    char a[SIZE] = "";
    char b[SIZE] = "";
    double x = 0.0;
    if (line[0] == '<') {
        circuit[*n_lines] = strdup(line[1] == ' ' ? line + 2 : line + 1);
        *n_lines += *n_lines < MOST_LINES - 1;
    } else if (strcmp(line, "circ") == 0) {
        circuit[*n_lines] = NULL;
        printf("circ %d\n", ng.circ(circuit));
        while (*n_lines > 0) {
            free(circuit[--*n_lines]);
        }
    } else if (line[0] == '!') {
        const bool starts = strncmp(line + 2, "bg_", 3) == 0 && strcmp(line + 2, "bg_halt") != 0;
        told.ended_before = starts ? told.ended : told.ended_before;
        const int result = ng.command(line + 2);
        if (strncmp(line + 2, "bg_", 3) != 0) { /* it has waited for the thread */
            print_kept();
        }
        printf("%s: %d\n", line, result);
    } else if (strcmp(line, "null") == 0) {
        printf("null %d\n", ng.command(NULL));
    } else if (strcmp(line, "plots") == 0) {
        print_list("plots", ng.plots(), false);
    } else if (strcmp(line, "current") == 0) {
        printf("current %s\n", ng.current());
    } else if (sscanf(line, "vecs %3999s", a) == 1) {
        print_list(line, ng.vecs(a), true);
    } else if (sscanf(line, "vector %3999s", a) == 1) {
        print_vector(a);
    } else if (sscanf(line, "at %3999s %3999s %lf", a, b, &x) == 3) {
        print_at(a, b, x);
    } else if (sscanf(line, "last %3999s", a) == 1) {
        print_value("last", a);
    } else if (sscanf(line, "most %3999s", a) == 1) {
        print_value("most", a);
    } else if (sscanf(line, "input %3999s", a) == 1) {
        ng.input_path(a);
    } else if (strcmp(line, "running") == 0) {
        printf("running %d\n", ng.running());
    } else if (strcmp(line, "slow") == 0 || strcmp(line, "fast") == 0) {
        told.slow = line[0] == 's';
    } else if (strcmp(line, "breakpoint") == 0) {
        printf("breakpoint %d\n", ng.set_breakpoint(1e-3));
    } else if (strcmp(line, "wait") == 0) {
        while (ng.running() || told.ended == told.ended_before) {
            nap();
        }
        print_kept();
    } else if (sscanf(line, "begun %3999s", a) == 1) {
        const vector_info *v;
        while ((v = ng.vector(a)) == NULL || v->v_length < 2) {
            nap();
        }
    } else if (sscanf(line, "threaded %3999s %3999[^\n]", a, b) == 2) {
        read_while_running(a, b);
    } else if (strcmp(line, "counts") == 0) {
        printf("counts lines %d errors %d rows %d plots %ld vectors %ld begun %ld ended %ld exits "
               "%ld\n",
               told.lines > 0, told.errors > 0, told.rows > 0, (long)told.plots, (long)told.vectors,
               (long)told.begun, (long)told.ended, (long)told.exits);
    } else if (line[0] != '\0' && line[0] != '#') {
        printf("not understood: %s\n", line);
    }
    fflush(stdout);
}

static void *find(void *library, const char *name) {
    void *found = dlsym(library, name);
    if (found == NULL) {
        fprintf(stderr, "client: no %s\n", name);
        exit(2);
    }
    return found;
}

int main(int argc, char **argv) {
    static char line[SIZE];
    static char *circuit[MOST_LINES];
    int n_lines = 0;
    int id = 7;
    void *library = argc > 1 ? dlopen(argv[1], RTLD_NOW) : NULL;
    if (library == NULL) {
        fprintf(stderr, "client: %s\n", argc > 1 ? dlerror() : "client LIBRARY [talk] [nodata]");
        return 2;
    }
    told.self = pthread_self();
    told.talks = argc > 2 && strcmp(argv[2], "talk") == 0;
    const bool is_bare = argc > 2 && strcmp(argv[argc - 1], "nodata") == 0; /* as KiCad */
    ng.init = find(library, "ngSpice_Init");
    ng.init_sync = find(library, "ngSpice_Init_Sync");
    ng.command = find(library, "ngSpice_Command");
    ng.circ = find(library, "ngSpice_Circ");
    ng.vector = find(library, "ngGet_Vec_Info");
    ng.current = find(library, "ngSpice_CurPlot");
    ng.plots = find(library, "ngSpice_AllPlots");
    ng.vecs = find(library, "ngSpice_AllVecs");
    ng.running = find(library, "ngSpice_running");
    ng.set_breakpoint = find(library, "ngSpice_SetBkpt");
    ng.input_path = find(library, "ngCM_Input_Path");
    printf("init %d\n", ng.init(on_char, on_status, on_exit_asked, is_bare ? NULL : on_data,
                                is_bare ? NULL : on_init_data, on_thread, NULL));
    printf("sync %d\n", ng.init_sync(NULL, NULL, NULL, &id, NULL));
    while (fgets(line, sizeof line, stdin) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        execute(line, circuit, &n_lines);
    }
    return 0;
}
