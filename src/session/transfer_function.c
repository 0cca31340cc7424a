/* transfer_function.c - .tf: the gain from a source to an output around the operating point, and two resistances.
 *
 * Two responses at 0 Hz, by which capacitors are open and coils are shorts: to 1 V or 1 A of the source alone, and to 1 A
 * between the nodes of the output alone, or 1 V of the source whose current is the output. */
#include "small_signal.h"

#include <float.h>
#include <math.h>

/* The AC values of all sources, which .tf puts others in place of. */
struct ac_values {
    double *real, *imaginary; /* [n_stimuli] */
};

static enum dalcs_status keep_values(struct ac_values *kept, struct dalcs_session *s) {
    const struct dalcs_circuit *c = &s->circuit;
    kept->real = dalcs_arena_alloc(&s->arena, (size_t)c->n_stimuli, sizeof(double));
    kept->imaginary = dalcs_arena_alloc(&s->arena, (size_t)c->n_stimuli, sizeof(double));
    if (kept->real == NULL || kept->imaginary == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < c->n_stimuli; k++) {
        kept->real[k] = c->stimulus[k].ac_real;
        kept->imaginary[k] = c->stimulus[k].ac_imaginary;
    }
    return DALCS_OK;
}

static void restore_values(const struct ac_values *kept, struct dalcs_circuit *c) {
    for (int k = 0; k < c->n_stimuli; k++) {
        c->stimulus[k].ac_real = kept->real[k];
        c->stimulus[k].ac_imaginary = kept->imaginary[k];
    }
}

static void excite(struct dalcs_circuit *c, int stimulus) {
    for (int k = 0; k < c->n_stimuli; k++) {
        c->stimulus[k].ac_real = k == stimulus ? 1.0 : 0.0;
        c->stimulus[k].ac_imaginary = 0.0;
    }
}

/* The operating point with its matrices. */
struct frozen {
    struct dalcs_small_signal a;
    struct dalcs_euler e;
    struct dalcs_logic_run logic;
};

/* The current of a measured signal; what may be rounding alone is 0, so that a resistance without end shows as such. */
static double current_of(const struct dalcs_small_signal *a, int measured) {
    const struct dalcs_session *s = a->run->s;
    const struct dalcs_readout *r = s->network.readout;
    const int signal = s->circuit.results.measured[measured];
    const int device = s->circuit.results.signal[signal].device;
    const double value = a->row[2 * signal];
    double rounding = 0.0;
    for (int k = r->start[device]; k < r->start[device + 1]; k++) {
        const struct dalcs_small_signal_part *part = &a->part[r->device_system[device]];
        const double size = fabs(part->y[0][r->term[k].column]);
        rounding +=
            fabs(r->term[k].coefficient) *
            (DBL_EPSILON * size + dalcs_small_signal_part_rounding(part, r->term[k].column));
    }
    return fabs(value) <= rounding ? 0.0 : value;
}

static double value_of(const struct dalcs_small_signal *a, int measured) {
    const struct dalcs_circuit_results *results = &a->run->s->circuit.results;
    const int signal = results->measured[measured];
    return results->signal[signal].kind == DALCS_SIGNAL_CURRENT ? current_of(a, measured)
                                                                : a->row[2 * signal];
}

/* What the output and the input of .tf show of the response to one source. */
static enum dalcs_status respond(struct frozen *f, int stimulus, double *output, double *input) {
    struct dalcs_circuit *c = &f->a.run->s->circuit;
    const struct dalcs_transfer_card *tf = &c->analyses.transfer;
    excite(c, stimulus);
    enum dalcs_status status = dalcs_small_signal_setup(&f->a, &f->e, &f->logic, 1);
    status = status == DALCS_OK ? dalcs_small_signal_solve(&f->a, 0.0) : status;
    status = status == DALCS_OK ? dalcs_audit_response_look(&f->a.audit, 0, 0.0, f->a.row) : status;
    if (status == DALCS_OK) {
        *output = value_of(&f->a, tf->output);
        *input = value_of(&f->a, tf->input);
    }
    dalcs_small_signal_finish(&f->a);
    return status;
}

/* Of a source of 1 V, by the current into its first node. */
static double resistance(double current) {
    return current == 0.0 ? (double)INFINITY : -1.0 / current;
}

static enum dalcs_status find_values(struct frozen *f, double value[DALCS_N_TRANSFER]) {
    const struct dalcs_circuit *c = &f->a.run->s->circuit;
    const struct dalcs_transfer_card *tf = &c->analyses.transfer;
    const bool is_voltage = tf->output_device < 0;
    const int probe = is_voltage ? tf->probe : c->device[tf->output_device].stimulus;
    double output, input;
    DALCS_TRY(respond(f, c->device[tf->source].stimulus, &output, &input));
    value[DALCS_TRANSFER_GAIN] = output + 0.0; /* no -0 */
    value[DALCS_TRANSFER_INPUT] = tf->source_is_voltage ? resistance(input) : 0.0 - input;
    DALCS_TRY(respond(f, probe, &output, &input));
    value[DALCS_TRANSFER_OUTPUT] = is_voltage ? output + 0.0 : resistance(output);
    return DALCS_OK;
}

static enum dalcs_status show(struct dalcs_run *r, const double value[DALCS_N_TRANSFER]) {
    const struct dalcs_transfer_card *tf = &r->s->circuit.analyses.transfer;
    struct dalcs_report *report = &r->s->results.report;
    struct dalcs_arena *arena = &r->s->arena;
    const char **name = dalcs_arena_alloc(arena, DALCS_N_TRANSFER, sizeof *name);
    enum dalcs_unit *unit = dalcs_arena_alloc(arena, DALCS_N_TRANSFER, sizeof *unit);
    if (name == NULL || unit == NULL) {
        return DALCS_E_NOMEM;
    }
    const bool is_voltage = tf->output_device < 0;
    for (int k = 0; k < DALCS_N_TRANSFER; k++) {
        name[k] = dalcs_arena_printf(arena, "%s", tf->name[k]); /* the circuit ends before a step */
        unit[k] = DALCS_UNIT_OHM;
        if (name[k] == NULL) {
            return DALCS_E_NOMEM;
        }
        report->transfer.name[k] = name[k];
        report->transfer.value[k] = value[k];
    }
    if (!is_voltage || tf->source_is_voltage) {
        unit[DALCS_TRANSFER_GAIN] = DALCS_UNIT_NONE; /* a ratio, or siemens */
    }
    report->transfer.present = true;
    DALCS_TRY(dalcs_run_announce(r, &(struct dalcs_plot){.analysis = DALCS_TRANSFER,
                                                         .scale = "time",
                                                         .scale_unit = DALCS_UNIT_SECOND,
                                                         .n_signals = DALCS_N_TRANSFER,
                                                         .name = name,
                                                         .unit = unit}));
    DALCS_TRY(r->sink->row(r->sink->user, 0.0, value));
    return r->sink->end(r->sink->user);
}

enum dalcs_status dalcs_transfer_function_run(struct dalcs_run *r) {
    struct dalcs_circuit *c = &r->s->circuit;
    struct frozen f = {.a = {.run = r, .card = ".tf", .where = &c->analyses.transfer.where}};
    struct ac_values kept;
    double value[DALCS_N_TRANSFER];
    DALCS_TRY(keep_values(&kept, r->s));
    DALCS_TRY(dalcs_euler_setup(&f.e, c, &r->s->network, &r->osnsp, 1.0, 1.0));
    r->response_at = f.a.where;
    enum dalcs_status status = dalcs_small_signal_find_point(&f.a, &f.e, &f.logic);
    status = status == DALCS_OK ? find_values(&f, value) : status;
    restore_values(&kept, c);
    status = status == DALCS_OK ? show(r, value) : status;
    r->response_at = NULL;
    dalcs_run_add_work(r, &f.e);
    dalcs_logic_run_finish(&f.logic);
    dalcs_euler_finish(&f.e);
    return status;
}
