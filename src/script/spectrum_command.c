/* spectrum_command.c - the spectra of a transient: fft, psd, spec. */
#include "row_grid.h"
#include "spectrum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double TURN = 6.283185307179586;

/* Of one command. */
struct spectrum {
    struct dalcs_script *script;
    const struct dalcs_statement *statement;
    const struct dalcs_vector *scale;
    struct dalcs_grid grid; /* on which the rows are taken */
    bool is_sampled;    /* the rows are those on the grid: a run has others too, beside events */
    size_t first, n;    /* rows of it that are used */
    double *weight, *x; /* [n] in the arena: the window; a vector times it */
    double from, step;  /* Hz, of the first row and between rows of the spectrum */
    size_t n_out;
    size_t average; /* of psd: rows that are averaged */
};

static enum dalcs_status choose_window(struct spectrum *p) {
    const struct dalcs_variables *set = &p->script->variables;
    const char *name = dalcs_variables_get(set, "specwindow");
    const char *order = dalcs_variables_get(set, "specwindoworder");
    const long number = order != NULL ? strtol(order, NULL, 10) : 2;
    name = name != NULL ? name : "hanning";
    p->weight = dalcs_arena_alloc(&p->script->arena, p->n, sizeof *p->weight);
    p->x = dalcs_arena_alloc(&p->script->arena, p->n, sizeof *p->x);
    if (p->weight == NULL || p->x == NULL) {
        return DALCS_E_NOMEM;
    }
    if (dalcs_spectrum_window(name, number > 2 ? (int)number : 2, p->weight, p->n)) {
        return DALCS_OK;
    }
    return dalcs_script_refuse(p->script, p->statement,
                               "none, hanning, hamming, blackman, blackmanharris, flattop, "
                               "triangle, gaussian",
                               "specwindow: there is no window '%s'", name);
}

/* The rows of the current plot, at equal distances. */
static enum dalcs_status choose_rows(struct spectrum *p) {
    const struct dalcs_plot_vectors *plot = dalcs_plots_current(&p->script->vectors);
    if (!dalcs_plot_is_transient(plot)) {
        return dalcs_grid_refuse_plot(p->script, p->statement);
    }
    p->scale = plot->scale;
    p->grid = plot->grid;
    p->n = plot->scale->n;
    const size_t n_grid = dalcs_grid_rows(&plot->grid);
    if (n_grid == 0) { /* a plot that let has made */
        const double width = creal(plot->scale->value[p->n - 1] - plot->scale->value[0]);
        p->grid = (struct dalcs_grid){creal(plot->scale->value[0]), width / (double)(p->n - 1),
                                      creal(plot->scale->value[p->n - 1])};
    } else {
        p->is_sampled = true;
        p->n = n_grid;
    }
    return p->grid.step > 0.0 ? DALCS_OK : dalcs_grid_refuse_plot(p->script, p->statement);
}

static enum dalcs_status weigh(struct spectrum *p, const struct dalcs_vector *v) {
    const double complex *value =
        p->is_sampled ? dalcs_grid_sample(p->script, v, p->scale, &p->grid, p->first + p->n)
                      : v->value;
    for (size_t k = 0; value != NULL && k < p->n; k++) {
        p->x[k] = creal(value[p->first + k]) * p->weight[k];
    }
    return value != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* Amplitudes: those of a sine of 1 are 1, whatever the window. */
static enum dalcs_status transform(struct spectrum *p, double complex *to) {
    double complex *all = dalcs_alloc(p->n, sizeof *all);
    enum dalcs_status status =
        all != NULL ? dalcs_spectrum_transform(all, p->x, p->n) : DALCS_E_NOMEM;
    for (size_t k = 0; status == DALCS_OK && k < p->n_out; k++) {
        const bool is_single = k == 0 || 2 * k == p->n; /* it has no mirror */
        to[k] = all[k] * ((is_single ? 1.0 : 2.0) / (double)p->n);
        to[k] = is_single ? creal(to[k]) : to[k];
    }
    free(all);
    return status;
}

/* Power in each row over its width, V^2/Hz, as a mean of so many rows. */
static void find_density(const struct spectrum *p, const struct dalcs_vector *v,
                         double complex *value) {
    double total = 0.0;
    for (size_t k = 0; k < p->n_out; k++) {
        const bool is_single = k == 0 || 2 * k == p->n;
        const double amplitude = cabs(value[k]);
        value[k] = amplitude * amplitude * (is_single ? 1.0 : 0.5);
        total += creal(value[k]);
    }
    fprintf(p->script->host->out, "%s: power %.6e V^2 (or A^2), rms %.6e V (or A)\n", v->name,
            total, sqrt(total));
    for (size_t k = 0; k < p->n_out; k++) {
        value[k] /= p->step;
    }
}

static void smooth(const struct spectrum *p, const double complex *from, double complex *to) {
    for (size_t k = 0; k < p->n_out; k++) {
        const size_t half = p->average / 2;
        const size_t begin = k > half ? k - half : 0;
        size_t end = begin + p->average;
        end = end < p->n_out ? end : p->n_out;
        double complex sum = 0.0;
        for (size_t i = begin; i < end; i++) {
            sum += from[i];
        }
        to[k] = sum / (double)(end - begin);
    }
}

/* At any frequency, by the sum itself. */
static void sum_at(const struct spectrum *p, double complex *to) {
    for (size_t k = 0; k < p->n_out; k++) {
        const double f = p->from + (double)k * p->step;
        double complex sum = 0.0;
        for (size_t i = 0; i < p->n; i++) {
            sum += p->x[i] * cexp(-TURN * I * (f * dalcs_grid_time(&p->grid, p->first + i)));
        }
        to[k] = sum * ((f == 0.0 ? 1.0 : 2.0) / (double)p->n);
    }
}

static enum dalcs_status fill(struct spectrum *p, const struct dalcs_vector *v,
                              double complex *value) {
    DALCS_TRY(weigh(p, v));
    if (p->statement->kind == DALCS_STATEMENT_SPEC) {
        sum_at(p, value);
        return DALCS_OK;
    }
    DALCS_TRY(transform(p, value));
    if (p->statement->kind == DALCS_STATEMENT_FFT) {
        return DALCS_OK;
    }
    double complex *raw = dalcs_arena_alloc(&p->script->arena, p->n_out, sizeof *raw);
    if (raw == NULL) {
        return DALCS_E_NOMEM;
    }
    find_density(p, v, value);
    memcpy(raw, value, p->n_out * sizeof *raw);
    smooth(p, raw, value);
    return DALCS_OK;
}

static enum dalcs_status make_spectrum(struct spectrum *p, const struct dalcs_vector *const *vector,
                                       size_t n) {
    struct dalcs_vectors *all = &p->script->vectors;
    const struct dalcs_plot_vectors *from = dalcs_plots_current(all);
    const bool is_density = p->statement->kind == DALCS_STATEMENT_PSD;
    struct dalcs_vector made = {.unit = DALCS_UNIT_HERTZ, .n = p->n_out};
    double complex *value = dalcs_arena_alloc(&p->script->arena, p->n_out, sizeof *value);
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    made.value = value;
    for (size_t k = 0; k < p->n_out; k++) {
        value[k] = p->from + (double)k * p->step;
    }
    DALCS_TRY(dalcs_plots_make(all, "sp", is_density ? "PSD" : "Spectrum", from->title));
    struct dalcs_plot_vectors *to = all->current;
    to->analysis = DALCS_AC; /* complex vectors over a frequency */
    DALCS_TRY(dalcs_plot_set(to, "frequency", &made));
    made.is_complex = true;
    for (size_t k = 0; k < n; k++) {
        made.unit = is_density ? DALCS_UNIT_NONE : vector[k]->unit;
        DALCS_TRY(fill(p, vector[k], value));
        DALCS_TRY(dalcs_plot_set(to, vector[k]->name, &made));
    }
    return dalcs_grid_tell_made(p->script);
}

/* The last rows, so many that the step of the frequencies has whole periods in them: what repeats with it then
 * leaks nowhere. */
static enum dalcs_status use_whole_periods(struct spectrum *p) {
    const double n_periods = floor((double)p->n * p->grid.step * p->step * DALCS_ROUNDED_UP);
    const double n = round(n_periods / (p->step * p->grid.step));
    if (!(n >= 2.0 && n <= (double)p->n)) {
        return dalcs_script_refuse(p->script, p->statement, "a longer tran, or a larger step",
                                   "the rows are shorter than a period of %g Hz", p->step);
    }
    p->first = p->n - (size_t)n;
    p->n = (size_t)n;
    return DALCS_OK;
}

/* spec start stop step: the frequencies. */
static enum dalcs_status take_frequencies(struct spectrum *p, const char **text) {
    double value[3];
    for (int k = 0; k < 3; k++) {
        const char *word = dalcs_script_word(p->script, text);
        if (word == NULL) {
            return dalcs_script_refuse(p->script, p->statement, "spec 0 10k 50 v(out)",
                                       "the first and the last frequency and the step are missing");
        }
        DALCS_TRY(dalcs_script_number(p->script, p->statement, word, &value[k]));
    }
    const double highest = 0.5 / p->grid.step;
    const double n = floor((value[1] - value[0]) / value[2] * DALCS_ROUNDED_UP) + 1.0;
    if (!(value[0] >= 0.0 && value[2] > 0.0 && n >= 1.0 && n <= DALCS_MOST_GRID_ROWS)) {
        return dalcs_script_refuse(p->script, p->statement, "spec 0 10k 50 v(out)",
                                   "no frequencies lie every %g Hz from %g Hz to %g Hz", value[2],
                                   value[0], value[1]);
    }
    if (value[1] > highest * DALCS_ROUNDED_UP) {
        return dalcs_script_refuse(p->script, p->statement, "a smaller tstep of tran",
                                   "rows every %g s contain nothing above %g Hz", p->grid.step,
                                   highest);
    }
    p->from = value[0];
    p->step = value[2];
    p->n_out = (size_t)n;
    return use_whole_periods(p);
}

/* psd [average]: rows that are averaged. */
static enum dalcs_status take_average(struct spectrum *p, const char **text) {
    const char *rest = *text;
    const char *word = dalcs_script_word(p->script, &rest);
    double n = 1.0;
    p->average = 1;
    if (word == NULL || dalcs_parse_number(word, &n) != DALCS_OK) {
        return DALCS_OK;
    }
    *text = rest;
    if (!(n >= 1.0 && n <= (double)p->n_out)) {
        return dalcs_script_refuse(p->script, p->statement, "psd 1 v(out)",
                                   "%g rows cannot be averaged", n);
    }
    p->average = (size_t)n;
    return DALCS_OK;
}

/* fft v(out) ..., psd n v(out) ..., spec start stop step v(out) ... */
enum dalcs_status dalcs_script_fft(struct dalcs_script *script, const struct dalcs_statement *s) {
    struct spectrum p = {.script = script, .statement = s};
    const struct dalcs_vector **vector;
    const char *text;
    size_t n;
    DALCS_TRY(choose_rows(&p));
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    p.n_out = p.n / 2 + 1;
    p.step = 1.0 / ((double)p.n * p.grid.step);
    if (s->kind == DALCS_STATEMENT_SPEC) {
        DALCS_TRY(take_frequencies(&p, &text));
    } else if (s->kind == DALCS_STATEMENT_PSD) {
        DALCS_TRY(take_average(&p, &text));
    }
    DALCS_TRY(choose_window(&p));
    DALCS_TRY(dalcs_script_vectors(script, s, text, &vector, &n));
    size_t n_real = 0;
    for (size_t k = 0; k < n; k++) {
        if (vector[k]->n != p.scale->n || vector[k]->is_complex) {
            return dalcs_script_refuse(
                script, s, NULL, "'%s' is not real or not as long as the time", vector[k]->name);
        }
        if (strcmp(vector[k]->name, p.scale->name) != 0) {
            vector[n_real++] = vector[k];
        }
    }
    return make_spectrum(&p, vector, n_real);
}
