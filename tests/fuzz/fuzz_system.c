/* fuzz_system.c - libFuzzer target: any bytes to a DALCS to a few implicit Euler steps.
 *
 * The engine must be safe with whatever the reader accepts: any numbers, singular in any way, not
 * passive. Beside not crashing, an answer that it returns must be finite and certified, and must
 * satisfy the equations as this file works them out. Systems are kept small, so that every input
 * takes a bounded time. */
#include "osnsp.h"
#include "system_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed);

enum { MAX_COLUMNS = 40, MAX_PAIRS = 6, MAX_INPUTS = 16, N_STEPS = 3 };

static void require(bool condition) {
    if (!condition) {
        abort();
    }
}

static bool is_moderate(const struct dalcs_csr *a, double factor) {
    for (int k = 0; k < a->p[a->n_rows]; k++) {
        double size = factor * fabs(a->x[k]);
        if (!(size >= 1e-4 && size <= 1e4)) {
            return false;
        }
    }
    return true;
}

/* The certificate measures volts and amperes by each other through the conductances around diodes:
 * among coefficients of 1e4 and 1e-4 that may be worth seven digits of its 2e-13. */
static void check_rows(const struct dalcs_system *s, double sigma, const double *u,
                       const double *y) {
    double largest = 0.0;
    if (!is_moderate(&s->A, 1.0) || !is_moderate(&s->C, 1.0) || !is_moderate(&s->P, sigma) ||
        !is_moderate(&s->E, 1.0) || !is_moderate(&s->F, 1.0)) {
        return;
    }
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        require(isfinite(y[c]));
        largest = fmax(largest, fabs(y[c]));
    }
    for (int i = 0; i < s->n_x + s->n_inputs; i++) {
        largest = fmax(largest, fabs(u[i]));
    }
    for (int i = 0; i < dalcs_system_n_equations(s); i++) {
        double sum = dalcs_csr_row_dot(&s->A, i, y) + dalcs_csr_row_dot(&s->E, i, u + s->n_x);
        double norm = 0.0;
        for (int k = s->A.p[i]; k < s->A.p[i + 1]; k++) {
            norm += fabs(s->A.x[k]);
        }
        for (int k = s->E.p[i]; k < s->E.p[i + 1]; k++) {
            norm += fabs(s->E.x[k]);
        }
        for (int k = i < s->n_x ? s->P.p[i] : 0; i < s->n_x && k < s->P.p[i + 1]; k++) {
            sum -= sigma * s->P.x[k] * (y[s->P.j[k]] - u[s->P.j[k]]);
            norm += sigma * fabs(s->P.x[k]);
        }
        require(!(fabs(sum) > 1e-6 * norm * largest));
    }
}

static void solve(const struct dalcs_system_file *file) {
    const struct dalcs_system *s = &file->system;
    const struct dalcs_osnsp_options options = {.certificate_tolerance = 2e-13,
                                                .proximal_weight = 1e-8,
                                                .rcond_min = 1e-14,
                                                .max_outer = 10,
                                                .max_pivots = 20,
                                                .cache_bytes = 100000,
                                                .dense_limit = 64};
    struct dalcs_osnsp p;
    double u[MAX_COLUMNS + MAX_INPUTS];
    double y[MAX_COLUMNS] = {0.0};
    require(dalcs_osnsp_setup(&p, s, &options) == DALCS_OK);
    memcpy(p.mode, file->mode, (size_t)p.n_words * sizeof(*p.mode));
    memcpy(u, file->u, (size_t)(s->n_x + s->n_inputs) * sizeof(*u));
    for (int step = 0; step < N_STEPS; step++) {
        enum dalcs_status status = dalcs_osnsp_solve(&p, file->sigma, u, y);
        require(status >= DALCS_OK);
        if (status != DALCS_OK) {
            break;
        }
        require(p.certificate.worst <= options.certificate_tolerance);
        check_rows(s, file->sigma, u, y);
        memcpy(u, y, (size_t)s->n_x * sizeof(*u));
    }
    dalcs_osnsp_finish(&p);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct dalcs_diag diag = {0};
    struct dalcs_system_file file;
    enum dalcs_status status =
        dalcs_system_file_read_text(&file, "fuzz", (const char *)data, size, &diag);
    require((status == DALCS_E_NETLIST) == (diag.n_errors == 1));
    if (status == DALCS_OK && dalcs_system_n_columns(&file.system) <= MAX_COLUMNS &&
        file.system.n_pairs <= MAX_PAIRS && file.system.n_inputs <= MAX_INPUTS) {
        solve(&file);
    } else if (status != DALCS_OK) {
        require(file.u == NULL && file.system.P.p == NULL);
    }
    dalcs_system_file_finish(&file);
    dalcs_diag_finish(&diag);
    return 0;
}

/* ---- Mutation ------------------------------------------------------------------------------ */

/* Random bytes seldom leave a system: half of the inputs are made by changing a word into another. */
static const char *const word[] = {
    "0",     "1",      "-1",    "2",    "3",      "0.5",
    "-2",    "1e-3",   "1e3",   "1e9",  "1e-12",  "1e15",
    "1e100", "1e-300", "1e308", "-1e9", "1e-8",   "0.33333333333333331",
    "V",     "A",      "state", "node", "branch", "reference",
    "diode", "switch", "4",     "5",    "6",      "7"};

enum { N_WORDS = sizeof(word) / sizeof(word[0]) };

static bool ends_word(uint8_t c) {
    return c == ' ' || c == '\n';
}

/* Puts text[length] in the place of data[begin..end-1]; the new size, or the old when it is full. */
static size_t replace(uint8_t *data, size_t size, size_t max_size, size_t begin, size_t end,
                      const char *text) {
    size_t length = strlen(text);
    if (size - (end - begin) + length > max_size) {
        return size;
    }
    memmove(data + begin + length, data + end, size - end);
    memcpy(data + begin, text, length);
    return size - (end - begin) + length;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    if (seed % 2 == 0 || size == 0) {
        return LLVMFuzzerMutate(data, size, max_size);
    }
    uint64_t random = seed * 6364136223846793005u + 1442695040888963407u;
    size_t begin = (size_t)((random >> 33) % size);
    const char *text = word[(random >> 16) % N_WORDS];
    while (begin > 0 && !ends_word(data[begin - 1])) {
        begin--;
    }
    size_t end = begin;
    while (end < size && !ends_word(data[end])) {
        end++;
    }
    return replace(data, size, max_size, begin, end, text);
}
