/* ngspice_search.c - all device models with either method and the netlist's step; then, around the
 * two most exact ones, tighter tolerances with shorter and with longer steps. */
#include "ngspice_search.h"

#include "memory.h"
#include "quantity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WORTH_REPEATING 0.3 /* s; longer runs are timed once */

const double dalcs_error_level[DALCS_N_LEVELS] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

/* From stock to nearest ideal. */
static const struct {
    enum dalcs_spice_diode diode;
    double emission, on, off;
} device[] = {
    {DALCS_SPICE_STOCK, 1.0, 1.0, 1e12},         {DALCS_SPICE_EXPONENTIAL, 0.1, 1e-2, 1e8},
    {DALCS_SPICE_EXPONENTIAL, 1e-2, 1e-3, 1e9},  {DALCS_SPICE_EXPONENTIAL, 1e-3, 1e-4, 1e9},
    {DALCS_SPICE_EXPONENTIAL, 1e-4, 1e-5, 1e10}, {DALCS_SPICE_EXPONENTIAL, 1e-5, 1e-6, 1e10},
    {DALCS_SPICE_LINES, 1.0, 1e-3, 1e9},         {DALCS_SPICE_LINES, 1.0, 1e-6, 1e9},
};

static const char *const method[] = {"trap", "gear"};

/* What gets it through where it gives up: a resistance in series with a diode, conductances from nodes
 * to ground, or capacitors. */
static const struct {
    bool has_series;
    const char *options;
} rescue[] = {{true, NULL}, {false, "gmin=1e-9 rshunt=1e12"}, {false, "cshunt=1e-12"}};

/* Around the most exact ones. */
static const struct {
    double reltol, step; /* times the netlist's step */
} refinement[] = {
    {1e-4, 1.0},  {1e-5, 0.5},  {1e-6, 0.2},  {1e-7, 0.05}, {1e-3, 0.25},
    {1e-3, 0.05}, {1e-6, 10.0}, {1e-4, 10.0}, {1e-3, 20.0}, {1e-3, 100.0},
};

enum {
    N_DEVICES = sizeof device / sizeof device[0],
    N_METHODS = sizeof method / sizeof method[0],
    N_RESCUES = sizeof rescue / sizeof rescue[0],
    N_REFINEMENTS = sizeof refinement / sizeof refinement[0],
    N_REFINED = 2
};

static enum dalcs_status write_netlist(const struct dalcs_ngspice_search *search,
                                       const struct dalcs_spice_options *options, char **text) {
    size_t size = 0;
    *text = NULL;
    FILE *stream = open_memstream(text, &size);
    if (!stream) {
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status =
        dalcs_session_write_spice(search->reference->session, options, stream);
    bool failed = ferror(stream) != 0;
    failed = fclose(stream) != 0 || failed || !*text;
    status = status == DALCS_OK && failed ? DALCS_E_NOMEM : status;
    if (status != DALCS_OK) {
        free(*text);
        *text = NULL;
    }
    return status;
}

/* Keeps the waveforms and the netlist of what is best so far. */
static void keep(struct dalcs_ngspice_search *search, int k, double *value, char *netlist) {
    const struct dalcs_trial *trial = search->trial;
    if (trial[k].options.diode == DALCS_SPICE_STOCK && trial[k].options.on == device[0].on &&
        (search->stock < 0 ||
         trial[k].deviation.worst_rms < trial[search->stock].deviation.worst_rms)) {
        search->stock = k;
        memcpy(search->stock_value, value,
               search->reference->times.n * search->reference->n_signals * sizeof *value);
    }
    if (search->best < 0 ||
        trial[k].deviation.worst_rms < trial[search->best].deviation.worst_rms) {
        search->best = k;
        memcpy(search->best_value, value,
               search->reference->times.n * search->reference->n_signals * sizeof *value);
        free(search->best_netlist);
        search->best_netlist = netlist;
    } else {
        free(netlist);
    }
}

static enum dalcs_status evaluate(struct dalcs_ngspice_search *search, int k,
                                  const struct dalcs_ngspice_raw *raw, char *netlist) {
    const struct dalcs_reference *reference = search->reference;
    double *value = dalcs_alloc(reference->times.n * reference->n_signals, sizeof *value);
    enum dalcs_status status = value ? dalcs_ngspice_sample(raw, reference, value) : DALCS_E_NOMEM;
    if (status == DALCS_OK) {
        status = dalcs_deviation_measure(&search->trial[k].deviation, reference, value);
    }
    if (status == DALCS_OK) {
        keep(search, k, value, netlist);
    } else {
        free(netlist);
    }
    free(value);
    return status;
}

/* The trial's index goes to *k; -1 when there is no room for more. */
static enum dalcs_status try_options(struct dalcs_ngspice_search *search,
                                     const struct dalcs_spice_options *options, int *k) {
    *k = -1;
    if (search->n_trials == DALCS_MAX_TRIALS) {
        return DALCS_OK;
    }
    if (search->on_trial) {
        search->on_trial(search->user, search->n_trials + 1);
    }
    char *netlist = NULL;
    enum dalcs_status status = write_netlist(search, options, &netlist);
    if (status == DALCS_OK && search->n_trials == 0) {
        status = dalcs_ngspice_time_start(search->ngspice, netlist);
    }
    struct dalcs_ngspice_run run = {0};
    if (status == DALCS_OK) {
        status = dalcs_ngspice_simulate(search->ngspice, netlist, search->reference->stop, &run);
    }
    if (status != DALCS_OK) {
        free(netlist);
        dalcs_ngspice_run_finish(&run);
        return status;
    }
    *k = search->n_trials++;
    struct dalcs_trial *trial = &search->trial[*k];
    *trial = (struct dalcs_trial){.options = *options,
                                  .is_too_slow = run.is_too_slow,
                                  .reached = run.reached,
                                  .cpu_s = run.cpu_s,
                                  .points = run.raw.n_points};
    memcpy(trial->reason, run.reason, sizeof trial->reason);
    if (trial->reason[0] != '\0') {
        search->n_gave_up++;
        free(netlist);
    } else {
        status = evaluate(search, *k, &run.raw, netlist);
    }
    dalcs_ngspice_run_finish(&run);
    return status;
}

static bool gave_up(const struct dalcs_ngspice_search *search, int k) {
    return k >= 0 && search->trial[k].reason[0] != '\0';
}

/* And where it gives up, with its rescues. */
static enum dalcs_status try_hard(struct dalcs_ngspice_search *search,
                                  struct dalcs_spice_options options, int *k) {
    enum dalcs_status status = try_options(search, &options, k);
    for (int i = 0; i < N_RESCUES && status == DALCS_OK && gave_up(search, *k) &&
                    !search->trial[*k].is_too_slow;
         i++) {
        if (rescue[i].has_series && options.diode != DALCS_SPICE_EXPONENTIAL) {
            continue;
        }
        options.series = rescue[i].has_series ? options.on : 0.0;
        options.extra_options = rescue[i].options;
        status = try_options(search, &options, k);
    }
    return status;
}

static enum dalcs_status try_devices(struct dalcs_ngspice_search *search) {
    for (int d = 0; d < N_DEVICES; d++) {
        bool differs = search->has_diodes ||
                       (search->has_switches && device[d].diode != DALCS_SPICE_LINES) || d == 0;
        for (int m = 0; m < N_METHODS && differs; m++) {
            int k = -1;
            enum dalcs_status status =
                try_hard(search,
                         (struct dalcs_spice_options){.diode = device[d].diode,
                                                      .emission = device[d].emission,
                                                      .on = device[d].on,
                                                      .off = device[d].off,
                                                      .edge = search->edge,
                                                      .max_step = search->step,
                                                      .method = method[m]},
                         &k);
            if (status != DALCS_OK) {
                return status;
            }
        }
    }
    return DALCS_OK;
}

/* The complete trials of least error, best first; returns their number. */
static int find_best(const struct dalcs_ngspice_search *search, int best[N_REFINED]) {
    int n = 0;
    for (int k = 0; k < search->n_trials; k++) {
        if (gave_up(search, k)) {
            continue;
        }
        int place = n < N_REFINED ? n++ : N_REFINED;
        for (; place > 0 && search->trial[k].deviation.worst_rms <
                                search->trial[best[place - 1]].deviation.worst_rms;
             place--) {
            if (place < N_REFINED) {
                best[place] = best[place - 1];
            }
        }
        if (place < N_REFINED) {
            best[place] = k;
        }
    }
    return n;
}

static enum dalcs_status refine(struct dalcs_ngspice_search *search) {
    int best[N_REFINED];
    int n = find_best(search, best);
    for (int i = 0; i < n; i++) {
        double cpu_s = search->trial[best[i]].cpu_s;
        for (int j = 0; j < N_REFINEMENTS; j++) {
            struct dalcs_spice_options options = search->trial[best[i]].options;
            options.reltol = refinement[j].reltol;
            options.max_step = refinement[j].step * search->step;
            int k = -1;
            if (search->ngspice->limit > 0.0 &&
                cpu_s / refinement[j].step > search->ngspice->limit) {
                continue; /* it would not end in time */
            }
            enum dalcs_status status = try_options(search, &options, &k);
            if (status != DALCS_OK) {
                return status;
            }
        }
    }
    return DALCS_OK;
}

/* Times it again: a single process time of some milliseconds says little. */
static enum dalcs_status time_again(struct dalcs_ngspice_search *search, int k) {
    if (k < 0 || search->trial[k].cpu_s > WORTH_REPEATING) {
        return DALCS_OK;
    }
    char *netlist = NULL;
    enum dalcs_status status = write_netlist(search, &search->trial[k].options, &netlist);
    for (int i = 0; i < 2 && status == DALCS_OK; i++) {
        struct dalcs_ngspice_run run = {0};
        status = dalcs_ngspice_simulate(search->ngspice, netlist, search->reference->stop, &run);
        search->trial[k].cpu_s = fmin(search->trial[k].cpu_s, run.cpu_s);
        dalcs_ngspice_run_finish(&run);
    }
    free(netlist);
    return status;
}

int dalcs_ngspice_search_fastest(const struct dalcs_ngspice_search *search, double level) {
    int fastest = -1;
    for (int k = 0; k < search->n_trials; k++) {
        if (!gave_up(search, k) && search->trial[k].deviation.worst_rms <= level &&
            (fastest < 0 || search->trial[k].cpu_s < search->trial[fastest].cpu_s)) {
            fastest = k;
        }
    }
    return fastest;
}

enum dalcs_status dalcs_ngspice_search_run(struct dalcs_ngspice_search *search) {
    size_t n = search->reference->times.n * search->reference->n_signals;
    search->stock = search->best = -1;
    search->stock_value = dalcs_alloc(n, sizeof *search->stock_value);
    search->best_value = dalcs_alloc(n, sizeof *search->best_value);
    if (!search->stock_value || !search->best_value) {
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status = try_devices(search);
    if (status == DALCS_OK) {
        status = refine(search);
    }
    if (status == DALCS_OK) {
        status = time_again(search, search->best);
    }
    if (status == DALCS_OK && search->stock != search->best) {
        status = time_again(search, search->stock);
    }
    for (int i = 0; i < DALCS_N_LEVELS && status == DALCS_OK; i++) {
        status = time_again(search, dalcs_ngspice_search_fastest(search, dalcs_error_level[i]));
    }
    return status;
}

void dalcs_trial_write(FILE *stream, const struct dalcs_ngspice_search *search,
                       const struct dalcs_spice_options *options) {
    char text[2][DALCS_QUANTITY_SIZE], series[DALCS_QUANTITY_SIZE];
    const char *on = dalcs_quantity_write(text[0], options->on, "ohm", 3);
    const char *off = dalcs_quantity_write(text[1], options->off, "ohm", 3);
    if (search->has_diodes) {
        switch (options->diode) {
        case DALCS_SPICE_STOCK:
            fputs("D stock; ", stream);
            break;
        case DALCS_SPICE_EXPONENTIAL:
            fprintf(stream, "D N=%g", options->emission);
            if (options->series > 0.0) {
                fprintf(stream, ", Rs %s", dalcs_quantity_write(series, options->series, "ohm", 3));
            }
            fputs("; ", stream);
            break;
        case DALCS_SPICE_LINES:
            fprintf(stream, "sidiode Ron %s, Roff %s; ", on, off);
            break;
        }
    }
    if (search->has_switches) {
        fprintf(stream, "S Ron %s, Roff %s; ", on, off);
    }
    fprintf(stream, "%s, reltol %g, tmax %s", options->method,
            options->reltol > 0.0 ? options->reltol : 1e-3,
            dalcs_quantity_write(text[0], options->max_step, "s", 3));
    if (options->extra_options) {
        fprintf(stream, ", %s", options->extra_options);
    }
}

void dalcs_ngspice_search_finish(struct dalcs_ngspice_search *search) {
    for (int k = 0; k < search->n_trials; k++) {
        dalcs_deviation_finish(&search->trial[k].deviation);
    }
    free(search->stock_value);
    free(search->best_value);
    free(search->best_netlist);
    *search = (struct dalcs_ngspice_search){0};
}
