/* spice.c - the cards of the netlist for ngspice. */
#include "spice.h"

#include <math.h>

struct writer {
    const struct dalcs_spice_names *names;
    const struct dalcs_circuit *circuit;
    const struct dalcs_spice_options *options;
    FILE *stream;
    struct dalcs_diag *diag;
};

static const char *node_of(const struct writer *w, int node) {
    return w->names->node[w->names->node_of[node]];
}

static const char *first_node(const struct writer *w, int i, char buffer[32]) {
    if (w->names->is_sensed[i]) {
        snprintf(buffer, 32, "x__%d", i);
        return buffer;
    }
    return node_of(w, w->circuit->device[i].node[0]);
}

/* The source of 0 V that measures what flows into a device. */
static void write_sense(const struct writer *w, int i) {
    if (w->names->is_sensed[i]) {
        fprintf(w->stream, "v__%d %s x__%d 0\n", i, node_of(w, w->circuit->device[i].node[0]), i);
    }
}

/* "d1 a k " */
static void write_head(const struct writer *w, int i) {
    char buffer[32];
    fprintf(w->stream, "%s %s %s ", w->names->device[i], first_node(w, i, buffer),
            node_of(w, w->circuit->device[i].node[1]));
}

static void write_value(const struct writer *w, const char *before, double value) {
    dalcs_spice_write_value(w->stream, before, value);
}

/* R, L and C, gains included: "l1 a b 1e-3 ic=2". */
static void write_passive(const struct writer *w, int i) {
    const struct dalcs_device *device = &w->circuit->device[i];
    if (dalcs_device_is_short(device)) { /* measured by its 0 V, else a single node */
        if (w->names->is_sensed[i]) {
            fprintf(w->stream, "v__%d %s %s 0\n", i, node_of(w, device->node[0]),
                    node_of(w, device->node[1]));
        }
        return;
    }
    write_sense(w, i);
    write_head(w, i);
    dalcs_spice_write_number(w->stream, device->value);
    if (device->has_initial) {
        write_value(w, " ic=", device->initial);
    }
    fputc('\n', w->stream);
}

static enum dalcs_status refuse(const struct writer *w, const struct dalcs_device *device,
                                const char *trouble) {
    dalcs_diag_add(w->diag, DALCS_ERROR, &device->where, NULL, "%s: ngspice has no %s",
                   device->name, trouble);
    return DALCS_E_NETLIST;
}

static enum dalcs_status write_source(const struct writer *w, int i) {
    const struct dalcs_device *device = &w->circuit->device[i];
    const struct dalcs_stimulus *stimulus = &w->circuit->stimulus[device->stimulus];
    bool is_voltage = device->kind == DALCS_VSOURCE;
    char buffer[32];
    write_sense(w, i);
    if (dalcs_spice_needs_expression(stimulus)) {
        if (is_voltage) { /* a source of the same name carries the current */
            fprintf(w->stream, "%s %s x__%d 0\nb__%d x__%d %s v=", w->names->device[i],
                    node_of(w, device->node[0]), i, i, i, node_of(w, device->node[1]));
        } else {
            fprintf(w->stream, "b__%d %s %s i=", i, first_node(w, i, buffer),
                    node_of(w, device->node[1]));
        }
        dalcs_spice_write_expression(w->stream, stimulus);
        fputc('\n', w->stream);
        return DALCS_OK;
    }
    write_head(w, i);
    const char *trouble = dalcs_spice_write_source(w->stream, stimulus, w->options->edge,
                                                   w->circuit->analyses.transient.stop);
    fputc('\n', w->stream);
    return trouble == NULL ? DALCS_OK : refuse(w, device, trouble);
}

static void write_controlled(const struct writer *w, int i) {
    const struct dalcs_device *device = &w->circuit->device[i];
    write_sense(w, i);
    write_head(w, i);
    if (device->control >= 0) {
        fprintf(w->stream, "%s ", w->names->device[device->control]);
    } else {
        fprintf(w->stream, "%s %s ", node_of(w, device->node[2]), node_of(w, device->node[3]));
    }
    dalcs_spice_write_number(w->stream, device->value);
    fputc('\n', w->stream);
}

/* An exponential with the forward voltage before it, the open resistance across and the breakdown, its
 * mirror, beside it. */
static void write_exponential(const struct writer *w, int i) {
    const struct dalcs_device *device = &w->circuit->device[i];
    const struct dalcs_diode_model *model = &w->circuit->models.of_diode[device->model];
    char buffer[32];
    const char *anode = first_node(w, i, buffer), *cathode = node_of(w, device->node[1]);
    if (model->vfwd != 0.0) {
        fprintf(w->stream, "vf__%d %s f__%d", i, anode, i);
        write_value(w, " ", model->vfwd);
        fprintf(w->stream, "\n%s f__%d %s m__%d\n", w->names->device[i], i, cathode, device->model);
    } else {
        fprintf(w->stream, "%s %s %s m__%d\n", w->names->device[i], anode, cathode, device->model);
    }
    if (isfinite(model->roff)) {
        fprintf(w->stream, "ro__%d %s %s", i, anode, cathode);
        write_value(w, " ", model->roff);
        fputc('\n', w->stream);
    }
    if (isfinite(model->vrev)) {
        fprintf(w->stream, "vb__%d %s b__%d", i, cathode, i);
        write_value(w, " ", model->vrev);
        fprintf(w->stream, "\ndb__%d b__%d %s mb__%d\n", i, i, anode, device->model);
    }
}

static void write_diode(const struct writer *w, int i) {
    const struct dalcs_device *device = &w->circuit->device[i];
    char buffer[32];
    write_sense(w, i);
    switch (w->options->diode) {
    case DALCS_SPICE_EXPONENTIAL:
        write_exponential(w, i);
        break;
    case DALCS_SPICE_STOCK:
        write_head(w, i);
        fprintf(w->stream, "m__%d\n", device->model);
        break;
    case DALCS_SPICE_LINES:
        fprintf(w->stream, "a__%d %%gd(%s %s) m__%d\n", i, first_node(w, i, buffer),
                node_of(w, device->node[1]), device->model);
        break;
    }
}

/* The control of a switch that closes below its threshold is negated; a current is turned around
 * by a source that makes a voltage of it. */
static void write_switch(const struct writer *w, int i) {
    const struct dalcs_device *device = &w->circuit->device[i];
    const struct dalcs_switch_model *model = &w->circuit->models.of_switch[device->model];
    bool by_current = device->control >= 0;
    write_sense(w, i);
    if (by_current && model->is_inverted) {
        char buffer[32];
        fprintf(w->stream, "h__%d h__%d 0 %s -1\ns__%d %s %s h__%d 0 ms__%d", i, i,
                w->names->device[device->control], i, first_node(w, i, buffer),
                node_of(w, device->node[1]), i, device->model);
    } else if (by_current) {
        write_head(w, i);
        fprintf(w->stream, "%s mw__%d", w->names->device[device->control], device->model);
    } else {
        int plus = model->is_inverted ? 3 : 2;
        write_head(w, i);
        fprintf(w->stream, "%s %s ms__%d", node_of(w, device->node[plus]),
                node_of(w, device->node[5 - plus]), device->model);
    }
    if (device->has_initial_state) {
        fputs(device->initially_on ? " on" : " off", w->stream);
    }
    fputc('\n', w->stream);
}

/* With the functions of time that no device before it had. */
static enum dalcs_status write_formula(const struct writer *w, int i) {
    const struct dalcs_device *device = &w->circuit->device[i];
    char buffer[32];
    write_sense(w, i);
    dalcs_spice_write_formula(w->names, w->options, w->stream, i, first_node(w, i, buffer));
    const char *trouble = NULL;
    for (int k = 0; k < w->circuit->n_stimuli && trouble == NULL; k++) {
        if (dalcs_spice_takes_stimulus(w->circuit, i, k)) {
            trouble = dalcs_spice_write_stimulus(w->circuit, w->stream, k, w->options->edge);
        }
    }
    return trouble == NULL ? DALCS_OK : refuse(w, device, trouble);
}

static enum dalcs_status write_device(const struct writer *w, int i) {
    const struct dalcs_device *device = &w->circuit->device[i];
    if (device->behaviour != NULL) {
        return write_formula(w, i);
    }
    switch (device->kind) {
    case DALCS_RESISTOR:
    case DALCS_INDUCTOR:
    case DALCS_CAPACITOR:
        write_passive(w, i);
        break;
    case DALCS_VSOURCE:
    case DALCS_ISOURCE:
        return write_source(w, i);
    case DALCS_VCVS:
    case DALCS_CCCS:
    case DALCS_VCCS:
    case DALCS_CCVS:
        write_controlled(w, i);
        break;
    case DALCS_DIODE:
        write_diode(w, i);
        break;
    case DALCS_SWITCH:
        write_switch(w, i);
        break;
    }
    return DALCS_OK;
}

static void write_couplings(const struct writer *w) {
    for (int i = 0; i < w->circuit->n_couplings; i++) {
        const struct dalcs_coupling *coupling = &w->circuit->coupling[i];
        fprintf(w->stream, "k__%d %s %s", i, w->names->device[coupling->inductor[0]],
                w->names->device[coupling->inductor[1]]);
        write_value(w, " ", coupling->k);
        fputc('\n', w->stream);
    }
}

static enum dalcs_status write_initial_conditions(const struct writer *w) {
    for (int i = 0; i < w->circuit->n_initial_conditions; i++) {
        const struct dalcs_initial_condition *ic = &w->circuit->initial_condition[i];
        int a = w->names->node_of[ic->node[0]], b = w->names->node_of[ic->node[1]];
        if (a != 0 && b != 0) {
            dalcs_diag_add(w->diag, DALCS_ERROR, &ic->where, NULL,
                           "ngspice has no .ic between two nodes");
            return DALCS_E_NETLIST;
        }
        fprintf(w->stream, ".ic v(%s)", w->names->node[a != 0 ? a : b]);
        write_value(w, "=", a != 0 ? ic->value : -ic->value);
        fputc('\n', w->stream);
    }
    return DALCS_OK;
}

static void write_analysis(const struct writer *w) {
    const struct dalcs_transient *t = &w->circuit->analyses.transient;
    const struct dalcs_spice_options *o = w->options;
    double netlists = t->max_step > 0.0     ? t->max_step
                      : t->step > 0.0       ? t->step
                      : t->first_step > 0.0 ? t->first_step
                                            : t->stop / 1000.0;
    double step = o->max_step > 0.0 ? o->max_step : netlists;
    fprintf(w->stream, ".options method=%s", o->method);
    if (o->reltol > 0.0) {
        write_value(w, " reltol=", o->reltol);
    }
    fprintf(w->stream, "%s%s\n", o->extra_options ? " " : "",
            o->extra_options ? o->extra_options : "");
    if (!t->present) {
        fputs(".op\n", w->stream);
        return;
    }
    write_value(w, ".tran ", step);
    write_value(w, " ", t->stop);
    write_value(w, " ", t->start);
    write_value(w, " ", step);
    fputs(t->use_initial_conditions ? " uic\n" : "\n", w->stream);
}

/* Only what is compared: the file with all there is would cost ngspice time. */
static void write_save(const struct writer *w) {
    for (int i = 0; i < w->circuit->results.n_signals; i++) {
        for (int k = 0; k < 2; k++) {
            if (w->names->column[i][k] != NULL) {
                fprintf(w->stream, ".save %s\n", w->names->column[i][k]);
            }
        }
    }
}

enum dalcs_status dalcs_spice_write(const struct dalcs_spice_names *names,
                                    const struct dalcs_spice_options *options, FILE *stream,
                                    struct dalcs_diag *diag) {
    const struct dalcs_circuit *circuit = names->circuit;
    const struct writer w = {names, circuit, options, stream, diag};
    fprintf(stream, "* %s\n", circuit->title);
    for (int i = 0; i < circuit->n_devices; i++) {
        DALCS_TRY(write_device(&w, i));
    }
    write_couplings(&w);
    for (int k = 0; k < circuit->models.n_diodes; k++) {
        dalcs_spice_write_diode_model(stream, circuit, options, k);
    }
    for (int k = 0; k < circuit->models.n_switches; k++) {
        dalcs_spice_write_switch_model(stream, circuit, options, k);
    }
    DALCS_TRY(write_initial_conditions(&w));
    write_analysis(&w);
    write_save(&w);
    fputs(".end\n", stream);
    return DALCS_OK;
}
