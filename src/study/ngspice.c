/* ngspice.c - a netlist in a temporary folder, `ngspice -b` on it, its raw file and what it said. */
#include "ngspice.h"

#include "memory.h"
#include "process.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define LEAST_CPU 1e-4 /* s; differences of process times mean nothing below */

enum { N_STARTS = 5 };

static char *join(const char *folder, const char *name) {
    size_t size = strlen(folder) + strlen(name) + 2;
    char *path = dalcs_alloc(size, 1);
    if (path) {
        snprintf(path, size, "%s/%s", folder, name);
    }
    return path;
}

static enum dalcs_status make_folder(struct dalcs_ngspice *ng) {
    const char *parent = getenv("TMPDIR");
    ng->folder = join(parent && *parent ? parent : "/tmp", "dalcs-XXXXXX");
    if (!ng->folder) {
        return DALCS_E_NOMEM;
    }
    if (!mkdtemp(ng->folder)) {
        free(ng->folder);
        ng->folder = NULL;
        return DALCS_E_IO;
    }
    ng->deck = join(ng->folder, "circuit.cir");
    ng->raw = join(ng->folder, "circuit.raw");
    return ng->deck && ng->raw ? DALCS_OK : DALCS_E_NOMEM;
}

/* Runs with these arguments; what it says goes to a temporary file, *log, that the caller closes. */
static enum dalcs_status run(struct dalcs_ngspice *ng, const char *const *argument,
                             struct dalcs_process *process, FILE **log) {
    *log = tmpfile();
    if (!*log) {
        return DALCS_E_IO;
    }
    *process = (struct dalcs_process){.argument = argument,
                                      .output = *log,
                                      .errors = *log,
                                      .limit = ng->limit,
                                      .interrupted = ng->interrupted};
    enum dalcs_status status = dalcs_process_run(process);
    rewind(*log);
    return status;
}

/* "** ngspice-39 : Circuit level simulation program" */
static void read_version(struct dalcs_ngspice *ng, FILE *log) {
    char line[256];
    snprintf(ng->version, sizeof ng->version, "ngspice");
    while (fgets(line, sizeof line, log)) {
        const char *name = strstr(line, "ngspice-");
        if (name) {
            snprintf(ng->version, sizeof ng->version, "%.*s", (int)strcspn(name, " \n"), name);
            return;
        }
    }
}

enum dalcs_status dalcs_ngspice_open(struct dalcs_ngspice *ng, const char *program, double limit,
                                     const volatile sig_atomic_t *interrupted,
                                     char message[DALCS_NGSPICE_TEXT_SIZE]) {
    *ng = (struct dalcs_ngspice){.program = program, .limit = limit, .interrupted = interrupted};
    const char *const argument[] = {program, "--version", NULL};
    struct dalcs_process process = {0};
    FILE *log = NULL;
    enum dalcs_status status = run(ng, argument, &process, &log);
    if (status == DALCS_OK) {
        read_version(ng, log);
        status = make_folder(ng);
        if (status != DALCS_OK) {
            snprintf(message, DALCS_NGSPICE_TEXT_SIZE, "cannot make a temporary folder: %s",
                     strerror(errno));
        }
    } else if (process.is_missing && strcmp(program, "ngspice") == 0) {
        snprintf(message, DALCS_NGSPICE_TEXT_SIZE,
                 "ngspice is not installed (on Debian: apt-get install ngspice)");
    } else {
        snprintf(message, DALCS_NGSPICE_TEXT_SIZE, "cannot run '%.200s': %s", program,
                 process.is_missing ? strerror(ENOENT) : strerror(errno));
    }
    if (log) {
        fclose(log);
    }
    if (status != DALCS_OK) {
        dalcs_ngspice_close(ng);
    }
    return status;
}

void dalcs_ngspice_close(struct dalcs_ngspice *ng) {
    if (ng->deck) {
        unlink(ng->deck);
    }
    if (ng->raw) {
        unlink(ng->raw);
    }
    if (ng->folder) {
        rmdir(ng->folder);
    }
    free(ng->deck);
    free(ng->raw);
    free(ng->folder);
    *ng = (struct dalcs_ngspice){0};
}

/* The netlist, and after its title line `control`. */
static enum dalcs_status write_deck(const struct dalcs_ngspice *ng, const char *netlist,
                                    const char *control) {
    FILE *file = fopen(ng->deck, "w");
    if (!file) {
        return DALCS_E_IO;
    }
    size_t title = strcspn(netlist, "\n");
    title += netlist[title] == '\n' ? 1 : 0;
    fwrite(netlist, 1, title, file);
    fputs(control, file);
    fputs(netlist + title, file);
    bool failed = ferror(file) != 0;
    return fclose(file) != 0 || failed ? DALCS_E_IO : DALCS_OK;
}

enum dalcs_status dalcs_ngspice_time_start(struct dalcs_ngspice *ng, const char *netlist) {
    const char *const argument[] = {ng->program, "-n", "-b", ng->deck, NULL};
    enum dalcs_status status = write_deck(ng, netlist, ".control\nquit\n.endc\n");
    ng->start_cpu_s = INFINITY;
    for (int i = 0; i < N_STARTS && status == DALCS_OK; i++) {
        struct dalcs_process process;
        FILE *log = NULL;
        status = run(ng, argument, &process, &log);
        if (log) {
            fclose(log);
        }
        ng->start_cpu_s = fmin(ng->start_cpu_s, status == DALCS_OK ? process.cpu_s : INFINITY);
    }
    return status;
}

/* The first line of its log that reads as a reason. */
static void read_reason(struct dalcs_ngspice_run *r, FILE *log) {
    static const char *const word[] = {"timestep too small", "singular",     "fatal",  "error",
                                       "no convergence",     "not converge", "aborted"};
    char line[DALCS_NGSPICE_TEXT_SIZE - 64] = "";
    while (fgets(line, sizeof line, log)) {
        line[strcspn(line, "\n")] = '\0';
        char low[sizeof line] = "";
        for (size_t i = 0; i < sizeof line; i++) {
            low[i] = (char)tolower((unsigned char)line[i]);
        }
        for (size_t i = 0; i < sizeof word / sizeof word[0]; i++) {
            if (strstr(low, word[i])) {
                const char *analysis = strstr(line, "TRAN: ");
                const char *text = analysis ? analysis + strlen("TRAN: ") : line;
                snprintf(r->reason, sizeof r->reason, "%s", text + strspn(text, " \t"));
                return;
            }
        }
    }
    snprintf(r->reason, sizeof r->reason, "no reason given");
}

static void judge(struct dalcs_ngspice_run *r, const struct dalcs_process *process, FILE *log,
                  double stop) {
    size_t n = r->raw.n_points;
    r->reached = n > 0 ? r->raw.value[(n - 1) * r->raw.n_columns] : 0.0;
    r->is_too_slow = process->is_too_slow;
    if (r->is_too_slow) {
        snprintf(r->reason, sizeof r->reason, "no end within %g s of CPU time", process->limit);
    } else if (n == 0 || r->reached < stop * (1.0 - 1e-9)) {
        read_reason(r, log);
    }
}

enum dalcs_status dalcs_ngspice_simulate(struct dalcs_ngspice *ng, const char *netlist, double stop,
                                         struct dalcs_ngspice_run *r) {
    *r = (struct dalcs_ngspice_run){.cpu_s = INFINITY};
    const char *const argument[] = {ng->program, "-n", "-b", "-r", ng->raw, ng->deck, NULL};
    unlink(ng->raw);
    enum dalcs_status status = write_deck(ng, netlist, "");
    if (status != DALCS_OK) {
        return status;
    }
    struct dalcs_process process;
    FILE *log = NULL;
    status = run(ng, argument, &process, &log);
    if (status == DALCS_OK) {
        r->cpu_s = fmax(process.cpu_s - ng->start_cpu_s, LEAST_CPU);
        status = dalcs_ngspice_raw_read(&r->raw, ng->raw);
        status = status == DALCS_E_IO ? DALCS_OK : status; /* no file: it gave up */
        judge(r, &process, log, stop);
    }
    if (log) {
        fclose(log);
    }
    return status;
}

void dalcs_ngspice_run_finish(struct dalcs_ngspice_run *r) {
    dalcs_ngspice_raw_finish(&r->raw);
    *r = (struct dalcs_ngspice_run){0};
}

/* ---- At the reference's times ---------------------------------------------------------------- */

/* Columns whose difference is a signal; n_columns: none, 0. */
struct column_pair {
    size_t plus, minus;
};

static double value_at(const struct dalcs_ngspice_raw *raw, size_t point,
                       const struct column_pair *pair) {
    const double *row = raw->value + point * raw->n_columns;
    return (pair->plus < raw->n_columns ? row[pair->plus] : 0.0) -
           (pair->minus < raw->n_columns ? row[pair->minus] : 0.0);
}

static double time_at(const struct dalcs_ngspice_raw *raw, size_t point) {
    return raw->value[point * raw->n_columns];
}

/* Lagrange through the points k-2 .. k+1; NAN where two of them have one time. */
static double cubic(const struct dalcs_ngspice_raw *raw, size_t k, const struct column_pair *pair,
                    double t) {
    double sum = 0.0;
    for (size_t i = k - 2; i <= k + 1; i++) {
        double term = value_at(raw, i, pair);
        for (size_t j = k - 2; j <= k + 1; j++) {
            double distance = time_at(raw, i) - time_at(raw, j);
            if (j != i) {
                term *= distance != 0.0 ? (t - time_at(raw, j)) / distance : NAN;
            }
        }
        sum += term;
    }
    return sum;
}

/* The nearer to `wanted`; k is the first point not before t. */
static double interpolate(const struct dalcs_ngspice_raw *raw, size_t k,
                          const struct column_pair *pair, double t, double wanted) {
    if (k == 0 || k == raw->n_points) {
        return value_at(raw, k == 0 ? 0 : k - 1, pair);
    }
    double from = time_at(raw, k - 1), to = time_at(raw, k);
    double part = to > from ? (t - from) / (to - from) : 1.0;
    double before = value_at(raw, k - 1, pair);
    double line = before + part * (value_at(raw, k, pair) - before);
    if (k < 2 || k + 1 >= raw->n_points) {
        return line;
    }
    double curve = cubic(raw, k, pair, t);
    return fabs(curve - wanted) < fabs(line - wanted) ? curve : line;
}

static enum dalcs_status find_columns(const struct dalcs_ngspice_raw *raw,
                                      const struct dalcs_reference *reference, size_t s,
                                      struct column_pair *pair) {
    const char *plus = NULL, *minus = NULL;
    enum dalcs_status status = dalcs_session_spice_columns(
        reference->session, reference->samples.plot->name[s], &plus, &minus);
    pair->plus = plus ? dalcs_ngspice_raw_find(raw, plus) : raw->n_columns;
    pair->minus = minus ? dalcs_ngspice_raw_find(raw, minus) : raw->n_columns;
    if (status == DALCS_OK &&
        ((plus && pair->plus == raw->n_columns) || (minus && pair->minus == raw->n_columns))) {
        status = DALCS_E_INTERNAL;
    }
    return status;
}

enum dalcs_status dalcs_ngspice_sample(const struct dalcs_ngspice_raw *raw,
                                       const struct dalcs_reference *reference, double *value) {
    size_t n = reference->n_signals;
    for (size_t s = 0; s < n; s++) {
        struct column_pair pair;
        enum dalcs_status status = find_columns(raw, reference, s, &pair);
        if (status != DALCS_OK) {
            return status;
        }
        size_t k = 0;
        for (size_t i = 0; i < reference->times.n; i++) {
            double t = reference->times.at[i];
            while (k < raw->n_points && time_at(raw, k) < t) {
                k++;
            }
            value[i * n + s] = interpolate(raw, k, &pair, t, reference->samples.value[i * n + s]);
        }
    }
    return DALCS_OK;
}
