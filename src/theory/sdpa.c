/* sdpa.c - a problem into a file, the program sdpa over it, its answer back. */
#include "sdpa.h"

#ifdef DALCS_WITH_SDPA

#include "process.h"

#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* s of sdpa's own time, against what never ends; problems here take hundredths. */
static const double limit = 60.0;

/* As the program comes, but for epsilonStar, epsilonDash and 17 digits. */
static const char parameters[] = "200 maxIteration\n1.0E-9 epsilonStar\n1.0E2 lambdaStar\n"
                                 "2.0 omegaStar\n-1.0E5 lowerBound\n1.0E5 upperBound\n"
                                 "0.1 betaStar\n0.2 betaBar\n0.9 gammaStar\n1.0E-9 epsilonDash\n"
                                 "%+.16e xPrint\nNOPRINT XPrint\n%+.16e YPrint\n%+.16e infPrint\n";

enum file { PROBLEM, PARAMETERS, ANSWER, TALK, N_FILES };

static const char *const file_name[] = {"problem.dat-s", "parameters", "answer", "talk"};

/* ---- Files ---------------------------------------------------------------------------------- */

/* NULL and a reason in s->why. */
static FILE *open_file(struct dalcs_sdpa *s, enum file file, const char *mode) {
    FILE *stream = fopen(s->path[file], mode);
    if (stream == NULL) {
        s->why = "the files for sdpa could not be written";
        s->lacks_memory = errno == ENOMEM;
    }
    return stream;
}

/* Numbers have a point, whatever the locale. */
static locale_t c_numbers(void) {
    locale_t c = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    return c == (locale_t)0 ? (locale_t)0 : uselocale(c);
}

static void own_numbers(locale_t before) {
    if (before != (locale_t)0) {
        freelocale(uselocale(before));
    }
}

const char *dalcs_sdpa_missing(void) {
    return NULL;
}

enum dalcs_status dalcs_sdpa_begin(struct dalcs_sdpa *s, struct dalcs_arena *arena, int n,
                                   const double *cost, int n_blocks, const int *size) {
    const char *parent = getenv("TMPDIR");
    *s = (struct dalcs_sdpa){.arena = arena, .n = n, .n_blocks = n_blocks};
    s->size = dalcs_arena_alloc(arena, (size_t)n_blocks, sizeof(*s->size));
    char *folder = dalcs_arena_printf(arena, "%s/dalcs-sdpa-XXXXXX",
                                      parent == NULL || *parent == '\0' ? "/tmp" : parent);
    if (s->size == NULL || folder == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(s->size, size, (size_t)n_blocks * sizeof(*size));
    s->folder = mkdtemp(folder);
    if (s->folder == NULL) {
        s->why = "no folder for sdpa's files could be made";
        return DALCS_OK;
    }
    for (int file = 0; file < N_FILES; file++) {
        s->path[file] = dalcs_arena_printf(arena, "%s/%s", folder, file_name[file]);
        if (s->path[file] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    s->problem = open_file(s, PROBLEM, "w");
    if (s->problem == NULL) {
        return s->lacks_memory ? DALCS_E_NOMEM : DALCS_OK;
    }
    locale_t before = c_numbers();
    fprintf(s->problem, "%d\n%d\n", n, n_blocks);
    for (int b = 0; b < n_blocks; b++) {
        fprintf(s->problem, "%d ", size[b]);
    }
    for (int i = 0; i < n; i++) {
        fprintf(s->problem, "%s%.17g", i == 0 ? "\n" : " ", cost[i]);
    }
    fprintf(s->problem, "\n");
    own_numbers(before);
    return DALCS_OK;
}

void dalcs_sdpa_put(struct dalcs_sdpa *s, int variable, int block, const struct dalcs_matrix *m) {
    if (s->problem == NULL) {
        return;
    }
    locale_t before = c_numbers();
    for (int j = 0; j < m->columns; j++) {
        for (int i = 0; i <= j; i++) {
            double value = *dalcs_at(m, i, j);
            if (value != 0.0) { /* sdpa subtracts its F_0 */
                fprintf(s->problem, "%d %d %d %d %.17g\n", variable, block + 1, i + 1, j + 1,
                        variable == 0 ? -value : value);
            }
        }
    }
    own_numbers(before);
}

void dalcs_sdpa_finish(struct dalcs_sdpa *s) {
    if (s->problem != NULL) {
        fclose(s->problem);
    }
    for (int file = 0; s->folder != NULL && file < N_FILES; file++) {
        if (s->path[file] != NULL) {
            unlink(s->path[file]);
        }
    }
    if (s->folder != NULL) {
        rmdir(s->folder);
    }
    *s = (struct dalcs_sdpa){0};
}

/* ---- The program ---------------------------------------------------------------------------- */

static void run(struct dalcs_sdpa *s) {
    FILE *talk = open_file(s, TALK, "w");
    if (talk == NULL) {
        return;
    }
    const char *const argument[] = {"sdpa",
                                    "-ds",
                                    s->path[PROBLEM],
                                    "-o",
                                    s->path[ANSWER],
                                    "-p",
                                    s->path[PARAMETERS],
                                    "-numThreads",
                                    "1",
                                    NULL};
    /* one thread, the same bits each time, and nothing of what this program was started with */
    const char *const environment[] = {"LC_ALL=C", "OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1",
                                       NULL};
    struct dalcs_process process = {.argument = argument,
                                    .environment = environment,
                                    .output = talk,
                                    .errors = talk,
                                    .limit = limit};
    enum dalcs_status status = dalcs_process_run(&process);
    s->lacks_memory = status != DALCS_OK && errno == ENOMEM;
    fclose(talk);
    s->why = process.is_missing    ? "the program sdpa is not there"
             : status != DALCS_OK  ? "the program sdpa could not be run"
             : process.is_too_slow ? "sdpa did not come to an end"
                                   : NULL;
}

/* The numbers after `title`; false when there are too few. */
static bool read_numbers(const char *text, const char *title, size_t n, double *value) {
    const char *at = strstr(text, title);
    for (size_t k = 0; at != NULL && k < n; k++) {
        char *rest;
        at += k == 0 ? strlen(title) : 0;
        at += strspn(at, "{}, \t\n");
        value[k] = strtod(at, &rest);
        at = rest == at || !isfinite(value[k]) ? NULL : rest;
    }
    return at != NULL;
}

static enum dalcs_status read_answer(struct dalcs_sdpa *s, struct dalcs_sdpa_answer *answer) {
    FILE *stream = open_file(s, ANSWER, "r");
    char *text = NULL;
    size_t length = 0;
    size_t n = 0;
    for (int b = 0; b < s->n_blocks; b++) {
        n += (size_t)s->size[b] * (size_t)s->size[b];
    }
    double *all = dalcs_arena_alloc(s->arena, n + 1, sizeof(double));
    answer->x = dalcs_arena_alloc(s->arena, (size_t)s->n + 1, sizeof(double));
    answer->dual = dalcs_arena_alloc(s->arena, (size_t)s->n_blocks, sizeof(*answer->dual));
    errno = 0;
    bool is_read = stream != NULL && getdelim(&text, &length, '\0', stream) > 0;
    s->lacks_memory = s->lacks_memory || (!is_read && errno == ENOMEM);
    if (stream != NULL) {
        fclose(stream);
    }
    if (all == NULL || answer->x == NULL || answer->dual == NULL || s->lacks_memory) {
        free(text);
        return DALCS_E_NOMEM;
    }
    locale_t before = c_numbers();
    is_read = is_read && read_numbers(text, "xVec =", (size_t)s->n, answer->x) &&
              read_numbers(text, "yMat =", n, all);
    own_numbers(before);
    free(text);
    for (int b = 0; b < s->n_blocks; b++) {
        answer->dual[b] = (struct dalcs_matrix){s->size[b], s->size[b], all};
        all += (size_t)s->size[b] * (size_t)s->size[b];
    }
    answer->is_solved = is_read;
    s->why = is_read ? NULL : "sdpa gave no answer";
    return DALCS_OK;
}

enum dalcs_status dalcs_sdpa_solve(struct dalcs_sdpa *s, struct dalcs_sdpa_answer *answer) {
    enum dalcs_status status = DALCS_OK;
    *answer = (struct dalcs_sdpa_answer){0};
    if (s->problem != NULL) {
        bool is_written = ferror(s->problem) == 0;
        is_written = fclose(s->problem) == 0 && is_written;
        s->problem = NULL;
        FILE *stream = open_file(s, PARAMETERS, "w");
        is_written = is_written && stream != NULL && fputs(parameters, stream) >= 0;
        is_written = (stream == NULL || fclose(stream) == 0) && is_written;
        s->why = is_written ? NULL : "the files for sdpa could not be written";
        if (is_written) {
            run(s);
        }
        status = s->lacks_memory  ? DALCS_E_NOMEM
                 : s->why == NULL ? read_answer(s, answer)
                                  : DALCS_OK;
    }
    answer->why = s->why;
    return status;
}

#else

const char *dalcs_sdpa_missing(void) {
    return "dalcs was built without SDPA";
}

enum dalcs_status dalcs_sdpa_begin(struct dalcs_sdpa *s, struct dalcs_arena *arena, int n,
                                   const double *cost, int n_blocks, const int *size) {
    (void)cost;
    (void)size;
    *s = (struct dalcs_sdpa){.arena = arena, .n = n, .n_blocks = n_blocks};
    return DALCS_OK;
}

void dalcs_sdpa_put(struct dalcs_sdpa *s, int variable, int block, const struct dalcs_matrix *m) {
    (void)s;
    (void)variable;
    (void)block;
    (void)m;
}

enum dalcs_status dalcs_sdpa_solve(struct dalcs_sdpa *s, struct dalcs_sdpa_answer *answer) {
    (void)s;
    *answer = (struct dalcs_sdpa_answer){.why = dalcs_sdpa_missing()};
    return DALCS_OK;
}

void dalcs_sdpa_finish(struct dalcs_sdpa *s) {
    (void)s;
}

#endif
