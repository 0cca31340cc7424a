/* run_statistics.c - moments by B. P. Welford (Technometrics 4, 1962): no digits are lost to a large mean. */
#include "run_statistics.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum dalcs_status dalcs_run_statistics_begin(struct dalcs_run_statistics *statistics, size_t n) {
    *statistics =
        (struct dalcs_run_statistics){.n = n, .of = dalcs_alloc(n, sizeof *statistics->of)};
    return statistics->of != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_run_statistics_add(struct dalcs_run_statistics *statistics, const double *value) {
    statistics->n_runs++;
    for (size_t k = 0; k < statistics->n; k++) {
        struct dalcs_run_moments *m = &statistics->of[k];
        if (!isfinite(value[k])) {
            continue;
        }
        m->least = m->n == 0 || value[k] < m->least ? value[k] : m->least;
        m->largest = m->n == 0 || value[k] > m->largest ? value[k] : m->largest;
        m->n++;
        const double difference = value[k] - m->mean;
        m->mean += difference / (double)m->n;
        m->squares += difference * (value[k] - m->mean);
    }
}

void dalcs_run_statistics_write(FILE *out, const struct dalcs_run_statistics *statistics,
                                const struct dalcs_session *session) {
    const char *name;
    int width = 12;
    for (size_t k = 0; (name = dalcs_session_measure_name(session, k)) != NULL; k++) {
        width = (int)strlen(name) > width ? (int)strlen(name) : width;
    }
    if (statistics->n == 0) {
        return;
    }
    char runs[32];
    (void)snprintf(runs, sizeof runs, "%zu runs", statistics->n_runs);
    fprintf(out, "\n  %-*s %11s %11s %11s %11s\n", width, runs, "mean", "sigma", "least",
            "largest");
    for (size_t k = 0; k < statistics->n && (name = dalcs_session_measure_name(session, k)) != NULL;
         k++) {
        const struct dalcs_run_moments *m = &statistics->of[k];
        const double sigma = m->n > 1 ? sqrt(m->squares / (double)(m->n - 1)) : (double)NAN;
        if (m->n == 0) {
            fprintf(out, "  %-*s %11s\n", width, name, "no value");
            continue;
        }
        fprintf(out, "  %-*s %11.6g %11.6g %11.6g %11.6g", width, name, m->mean, sigma, m->least,
                m->largest);
        if (m->n < statistics->n_runs) {
            fprintf(out, "  of %zu", m->n);
        }
        fputc('\n', out);
    }
}

void dalcs_run_statistics_finish(struct dalcs_run_statistics *statistics) {
    free(statistics->of);
    *statistics = (struct dalcs_run_statistics){0};
}
