/* bench_radau.c - error and CPU time of one circuit's transient, method by method.
 *
 *     bench_radau NETLIST REFERENCE.csv REPEATS method=euler,step=1e-6 method=radau,tol=1e-6 ...
 *
 * For each configuration one line of JSON: the error against the reference, the work, and the CPU
 * time of a run in each repeat, the mean of as many as fill a tenth of a second, a hundred at most:
 * ngspice's transients are timed in a row as well (ngspice_deck.py). Each run is a session of its
 * own, so that no factor is kept from the one before; the time is the report's, that of the run
 * without reading the netlist. The sink stores the reference's times only. Repeats take turns among
 * the configurations, so that what else the machine does hits all of them. What takes long is
 * repeated once only. */
#include <dalcs.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { LINE = 1 << 16 };

static const double LONG = 0.3;   /* s, repeated once only */
static const double LIMIT = 10.0; /* s, given up */
static const double FILLED = 0.1; /* s, by runs in a row */
static const int MOST_IN_A_ROW = 100;

struct reference {
    size_t n_rows, n_signals;
    char **name;
    double *time, *value; /* [n_rows], [n_rows][n_signals] */
};

/* What a run handed out, in the reference's columns. */
struct capture {
    const struct reference *reference;
    size_t *column; /* [n_signals] of the plot */
    size_t n_rows;
    double *value;
    double begin; /* s of the process's CPU time */
};

struct configuration {
    const char *text;
    struct dalcs_run_options options;
    char method[32];
    double error;
    const char *worst; /* the signal with that error */
    struct dalcs_report report;
    double *cpu; /* [repeats] */
    int n_cpu;
    bool failed;
};

static void *allocate(size_t n, size_t size) {
    void *p = calloc(n > 0 ? n : 1, size);
    if (p == NULL) {
        abort();
    }
    return p;
}

static char *copy(const char *text) {
    return strcpy(allocate(strlen(text) + 1, 1), text);
}

/* The next field of a CSV line, in place; quotes keep the comma of v(a,b). */
static char *field(char **rest) {
    char *at = *rest;
    char *end;
    if (*at == '"') {
        end = strchr(++at, '"');
        *end++ = '\0';
    } else {
        end = at + strcspn(at, ",\n");
    }
    *rest = *end == '\0' || *end == '\n' ? end : end + 1;
    *end = '\0';
    return at;
}

static bool read_reference(struct reference *r, const char *path) {
    FILE *f = fopen(path, "r");
    char *line = allocate(LINE, 1);
    size_t capacity = 0;
    *r = (struct reference){0};
    while (f != NULL && fgets(line, LINE, f) != NULL) {
        if (line[0] == '#') {
            continue;
        }
        char *rest = line;
        char *first = field(&rest);
        if (r->name == NULL) {
            r->name = allocate(LINE / 8, sizeof(*r->name));
            while (*rest != '\0') {
                r->name[r->n_signals++] = copy(field(&rest));
            }
            continue;
        }
        if (r->n_rows == capacity) {
            capacity = 2 * capacity + 128;
            r->time = realloc(r->time, capacity * sizeof(*r->time));
            r->value = realloc(r->value, capacity * r->n_signals * sizeof(*r->value));
            if (r->time == NULL || r->value == NULL) {
                abort();
            }
        }
        r->time[r->n_rows] = strtod(first, NULL);
        for (size_t k = 0; k < r->n_signals; k++) {
            r->value[r->n_rows * r->n_signals + k] = strtod(field(&rest), NULL);
        }
        r->n_rows++;
    }
    free(line);
    if (f != NULL) {
        fclose(f);
    }
    return r->n_rows > 0;
}

static enum dalcs_status on_begin(void *user, const struct dalcs_plot *plot) {
    struct capture *c = user;
    c->n_rows = 0;
    for (size_t k = 0; k < c->reference->n_signals; k++) {
        size_t j = 0;
        while (j < plot->n_signals && strcmp(plot->name[j], c->reference->name[k]) != 0) {
            j++;
        }
        if (j == plot->n_signals) {
            fprintf(stderr, "bench_radau: the netlist has no %s\n", c->reference->name[k]);
            return DALCS_E_OPTION;
        }
        c->column[k] = j;
    }
    return DALCS_OK;
}

static enum dalcs_status on_row(void *user, double time, const double *value) {
    struct capture *c = user;
    (void)time;
    if (c->n_rows < c->reference->n_rows) {
        for (size_t k = 0; k < c->reference->n_signals; k++) {
            c->value[c->n_rows * c->reference->n_signals + k] = value[c->column[k]];
        }
    }
    c->n_rows++;
    return DALCS_OK;
}

static double cpu_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A tolerance of 1e-10 with a method of first order would take days. */
static enum dalcs_status on_progress(void *user, double time, double stop) {
    const struct capture *c = user;
    (void)time, (void)stop;
    return cpu_seconds() - c->begin < LIMIT ? DALCS_OK : DALCS_E_CANCELLED;
}

/* Largest difference over the largest magnitude, of the worst signal. */
static double error_of(const struct capture *c, const char **worst) {
    const struct reference *r = c->reference;
    double largest = c->n_rows == r->n_rows ? 0.0 : INFINITY;
    *worst = "rows";
    for (size_t k = 0; k < r->n_signals; k++) {
        double scale = 0.0;
        double difference = 0.0;
        for (size_t j = 0; j < r->n_rows; j++) {
            size_t at = j * r->n_signals + k;
            scale = fmax(scale, fabs(r->value[at]));
            if (!isnan(r->value[at])) { /* nan: not unique there */
                difference = fmax(difference, fabs(c->value[at] - r->value[at]));
            }
        }
        if (difference > largest * scale) {
            largest = difference / scale;
            *worst = r->name[k];
        }
    }
    return largest;
}

static bool parse(struct configuration *c, const char *text, const struct reference *r) {
    char *words = copy(text);
    *c = (struct configuration){.text = text, .options = dalcs_run_options_default()};
    for (char *word = strtok(words, ","); word != NULL; word = strtok(NULL, ",")) {
        char *value = strchr(word, '=');
        if (value == NULL) {
            break;
        }
        *value++ = '\0';
        if (strcmp(word, "method") == 0) {
            snprintf(c->method, sizeof(c->method), "%s", value);
        } else if (strcmp(word, "step") == 0) {
            c->options.step = strtod(value, NULL);
        } else if (strcmp(word, "tol") == 0) {
            c->options.tolerance = strtod(value, NULL);
        } else if (strcmp(word, "stages") == 0) {
            c->options.stages = atoi(value);
        } else {
            fprintf(stderr, "bench_radau: what is '%s'?\n", word);
            free(words);
            return false;
        }
    }
    free(words);
    c->options.method = c->method;
    c->options.at = r->time;
    c->options.n_at = r->n_rows;
    return true;
}

/* The CPU time, s. */
static double run_once(struct configuration *c, const char *netlist, struct capture *capture,
                       bool timed) {
    struct dalcs_session *session;
    const struct dalcs_sink sink = {
        .user = capture, .begin = on_begin, .row = on_row, .progress = on_progress};
    capture->begin = cpu_seconds();
    if (dalcs_session_create(&session) != DALCS_OK) {
        abort();
    }
    enum dalcs_status status = dalcs_session_read_file(session, netlist);
    if (status == DALCS_OK) {
        status = dalcs_session_run(session, &c->options, &sink);
    }
    const struct dalcs_report *report = dalcs_session_report(session);
    double cpu = 0.0;
    if (status != DALCS_OK || report == NULL) {
        size_t n = dalcs_session_n_messages(session);
        fprintf(stderr, "bench_radau: %s: %s: %s\n", c->text, dalcs_status_text(status),
                n > 0 ? dalcs_session_message(session, n - 1, NULL) : "");
        c->failed = true;
    } else if (timed) {
        cpu = report->work.cpu_s;
    } else {
        c->error = error_of(capture, &c->worst);
        c->report = *report; /* the counters; the strings die with the session */
    }
    dalcs_session_destroy(session);
    return cpu;
}

static void run_in_a_row(struct configuration *c, const char *netlist, struct capture *capture) {
    double fill = ceil(FILLED / c->report.work.cpu_s);
    int n = fill < MOST_IN_A_ROW ? (int)fill : MOST_IN_A_ROW;
    double sum = 0.0;
    for (int k = 0; k < n; k++) {
        sum += run_once(c, netlist, capture, true);
    }
    c->cpu[c->n_cpu++] = sum / n;
}

static void print(const struct configuration *c) {
    printf("{\"configuration\": \"%s\"", c->text);
    if (!c->failed) {
        printf(", \"error\": %.4e, \"worst\": \"%s\", \"steps\": %ld, \"rejected\": %ld, "
               "\"factorizations\": %ld, \"certificate\": %.2g, \"cpu_s\": [",
               c->error, c->worst, c->report.work.steps, c->report.work.rejected,
               c->report.work.factorizations, c->report.certificate.worst);
        for (int k = 0; k < c->n_cpu; k++) {
            printf("%s%.9f", k > 0 ? ", " : "", c->cpu[k]);
        }
        printf("]");
    }
    printf("}\n");
}

int main(int argc, char **argv) {
    struct reference reference;
    if (argc < 5 || /* REPEATS may be 0: the errors only */
        !read_reference(&reference, argv[2])) {
        fprintf(stderr, "usage: bench_radau NETLIST REFERENCE.csv REPEATS method=NAME,step=H,"
                        "tol=TOL,stages=S ...\n");
        return 2;
    }
    int repeats = atoi(argv[3]);
    int n = argc - 4;
    size_t n_values = reference.n_rows * reference.n_signals;
    struct capture capture = {.reference = &reference};
    capture.column = allocate(reference.n_signals, sizeof(*capture.column));
    capture.value = allocate(n_values, sizeof(*capture.value));
    struct configuration *configuration = allocate((size_t)n, sizeof(*configuration));
    for (int k = 0; k < n; k++) {
        if (!parse(&configuration[k], argv[4 + k], &reference)) {
            return 2;
        }
        configuration[k].cpu = allocate((size_t)repeats, sizeof(double));
        (void)run_once(&configuration[k], argv[1], &capture, false); /* the error */
    }
    for (int r = 0; r < repeats; r++) {
        for (int k = 0; k < n; k++) {
            if (!configuration[k].failed && (r == 0 || configuration[k].report.work.cpu_s < LONG)) {
                run_in_a_row(&configuration[k], argv[1], &capture);
            }
        }
    }
    for (int k = 0; k < n; k++) {
        print(&configuration[k]);
        free(configuration[k].cpu);
    }
    free(configuration);
    free(capture.column);
    free(capture.value);
    for (size_t k = 0; k < reference.n_signals; k++) {
        free(reference.name[k]);
    }
    free(reference.name);
    free(reference.time);
    free(reference.value);
    return 0;
}
