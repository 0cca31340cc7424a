/* fuzz_netlist.c - libFuzzer target: any bytes to cards to a circuit to its DALCS, and a few steps.
 *
 * Beside not crashing, the outcome must be one that the next stage can rely on: errors come with
 * messages and leave nothing behind; a circuit has indices in range, values that are numbers, and
 * sources whose edges ascend; the rows and columns of its systems are paired one to one. */
#include "circuit.h"
#include "euler.h"
#include "netlist.h"
#include "network.h"
#include "radau.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition) {
    if (!condition) {
        abort();
    }
}

static void check_device(const struct dalcs_circuit *circuit, const struct dalcs_device *device) {
    require(device->name != NULL && device->where.file != NULL && device->where.line > 1);
    for (int k = 0; k < 4; k++) {
        require(device->node[k] >= 0 && device->node[k] < circuit->n_nodes);
    }
    require(isfinite(device->value) && isfinite(device->initial));
    require(device->stimulus < circuit->n_stimuli && device->control < circuit->n_devices);
    switch (device->kind) {
    case DALCS_VSOURCE:
    case DALCS_ISOURCE:
        require(device->stimulus >= 0);
        break;
    case DALCS_CCCS:
    case DALCS_CCVS:
        require(device->control >= 0 && circuit->device[device->control].kind == DALCS_VSOURCE);
        break;
    case DALCS_INDUCTOR:
    case DALCS_CAPACITOR:
        require(device->value > 0);
        break;
    case DALCS_DIODE:
        require(device->model >= 0 && device->model < circuit->models.n_diodes);
        require(circuit->models.of_diode[device->model].ron >= 0);
        require(circuit->models.of_diode[device->model].roff > 0);
        break;
    case DALCS_SWITCH:
        require(device->model >= 0 && device->model < circuit->models.n_switches);
        require(circuit->models.of_switch[device->model].vh >= 0);
        break;
    default:
        break;
    }
}

static void check_stimulus(const struct dalcs_stimulus *s) {
    double t = 0;
    for (int k = 0; k < 20 && !isinf(t); k++) {
        require(!isnan(dalcs_stimulus_value(s, t, DALCS_LEFT)));
        require(!isnan(dalcs_stimulus_value(s, t, DALCS_RIGHT)));
        const double next = dalcs_stimulus_next_edge(s, t);
        require(next > t);
        t = next;
    }
}

static bool has_analysis(const struct dalcs_circuit *circuit) {
    return circuit->analyses.operating_point || circuit->analyses.n_dc > 0 ||
           circuit->analyses.ac.n > 0 || dalcs_circuit_has_waves(circuit);
}

static void check_circuit(const struct dalcs_circuit *circuit) {
    require(circuit->n_nodes >= 1 && circuit->n_devices >= 1);
    require(strcmp(circuit->node_name[0], "0") == 0);
    for (int k = 0; k < circuit->n_devices; k++) {
        check_device(circuit, &circuit->device[k]);
    }
    for (int k = 0; k < circuit->n_stimuli; k++) {
        check_stimulus(&circuit->stimulus[k]);
    }
    for (int k = 0; k < circuit->n_couplings; k++) {
        const struct dalcs_coupling *c = &circuit->coupling[k];
        require(fabs(c->k) <= 1 && c->inductor[0] != c->inductor[1]);
        require(circuit->device[c->inductor[0]].kind == DALCS_INDUCTOR);
        require(circuit->device[c->inductor[1]].kind == DALCS_INDUCTOR);
    }
    for (int k = 0; k < circuit->n_initial_conditions; k++) {
        const struct dalcs_initial_condition *ic = &circuit->initial_condition[k];
        require(ic->node[0] < circuit->n_nodes && ic->node[1] < circuit->n_nodes);
        require(ic->node[0] != ic->node[1] && isfinite(ic->value));
    }
    for (int k = 0; k < circuit->results.n_signals; k++) {
        const struct dalcs_signal *signal = &circuit->results.signal[k];
        require(signal->name != NULL && signal->device < circuit->n_devices);
        require(signal->node[0] < circuit->n_nodes && signal->node[1] < circuit->n_nodes);
        require(signal->kind == DALCS_SIGNAL_VOLTAGE || signal->device >= 0);
    }
}

static void check_matrix(const struct dalcs_csr *a, int n_rows, int n_columns) {
    require(a->n_rows == n_rows);
    for (int k = 0; k < a->p[n_rows]; k++) {
        require(a->j[k] >= 0 && a->j[k] < n_columns);
    }
}

static void check_system(const struct dalcs_system *s) {
    int n_equations = dalcs_system_n_equations(s);
    int n_columns = dalcs_system_n_columns(s);
    check_matrix(&s->P, s->n_x, s->n_x);
    check_matrix(&s->A, n_equations, n_columns);
    check_matrix(&s->E, n_equations, s->n_inputs);
    check_matrix(&s->C, s->n_pairs, n_columns);
    check_matrix(&s->F, s->n_pairs, s->n_inputs);
    long sum = 0;
    for (int r = 0; r < n_equations; r++) {
        require(s->dual[r] >= 0 && s->dual[r] < n_equations);
        sum += s->dual[r];
    }
    require(sum == (long)n_equations * (n_equations - 1) / 2);
}

/* Every outcome of a step is fine, but none may take long: pivots are few. */
static const struct dalcs_osnsp_options options = {.certificate_tolerance = 2e-13,
                                                   .proximal_weight = 1e-8,
                                                   .rcond_min = 1e-14,
                                                   .max_outer = 5,
                                                   .max_pivots = 5,
                                                   .cache_bytes = (size_t)1 << 16,
                                                   .dense_limit = 24};

static void check_values(const struct dalcs_euler *e) {
    for (int k = 0; k < e->n_components; k++) {
        for (int c = 0; c < dalcs_system_n_columns(e->component[k].system); c++) {
            require(isfinite(e->component[k].y[c]));
        }
    }
}

/* A few segments of the default method: times ascend, values in between are numbers. */
static void follow(struct dalcs_radau *r) {
    enum { MOST_SEGMENTS = 40 };

    double t = 0.0;
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < MOST_SEGMENTS && status == DALCS_OK; k++) {
        bool happens;
        double next = fmin(dalcs_radau_next_stop(r, &happens), r->options.stop);
        require(next >= t);
        status = dalcs_radau_evaluate(r, t + 0.5 * (next - t), DALCS_LEFT);
        if (status == DALCS_OK) {
            status = dalcs_radau_evaluate(r, next, DALCS_LEFT);
        }
        if (status == DALCS_OK) {
            check_values(r->base);
        }
        if (status != DALCS_OK || next >= r->options.stop) {
            break;
        }
        r->base->t = next;
        t = next;
        status = dalcs_radau_pass(r, t);
    }
}

static void run_the_default(const struct dalcs_circuit *circuit,
                            const struct dalcs_network *network) {
    double stop = circuit->analyses.transient.present ? circuit->analyses.transient.stop : 1.0;
    const struct dalcs_radau_options accuracy = {.tolerance = 1e-6,
                                                 .abstol = circuit->options.abstol,
                                                 .vntol = circuit->options.vntol,
                                                 .stages = circuit->options.stages,
                                                 .fixed_step = circuit->options.step,
                                                 .max_step = circuit->analyses.transient.max_step,
                                                 .stop = stop};
    struct dalcs_euler e;
    struct dalcs_radau r;
    if (accuracy.max_step > 0.0 && stop / accuracy.max_step > 1e13) {
        return; /* refused before it comes to this */
    }
    if (accuracy.fixed_step > 0.0 &&
        (accuracy.fixed_step > stop || stop / accuracy.fixed_step > 1e13)) {
        return;
    }
    if (dalcs_euler_setup(&e, circuit, network, &options, stop / 7.0, stop) != DALCS_OK) {
        return;
    }
    if (dalcs_radau_setup(&r, &e, &accuracy, &options) == DALCS_OK) {
        bool from_initial = circuit->analyses.transient.use_initial_conditions;
        enum dalcs_status status = from_initial ? DALCS_OK : dalcs_euler_operating_point(&e, true);
        if (status == DALCS_OK) {
            dalcs_radau_start(&r, from_initial ? network->initial : NULL);
            status = dalcs_radau_begin(&r);
        }
        if (status == DALCS_OK) {
            follow(&r);
        }
        dalcs_radau_finish(&r);
    }
    dalcs_euler_finish(&e);
}

static void run_a_little(const struct dalcs_circuit *circuit, const struct dalcs_network *network) {
    double stop = circuit->analyses.transient.present ? circuit->analyses.transient.stop : 1.0;
    struct dalcs_euler e;
    if (dalcs_euler_setup(&e, circuit, network, &options, stop / 7.0, stop) != DALCS_OK) {
        return;
    }
    e.listener.detects_jumps = true;
    enum dalcs_status status = dalcs_euler_operating_point(&e, true);
    if (status == DALCS_OK || circuit->analyses.transient.use_initial_conditions) {
        status = dalcs_euler_start(
            &e, circuit->analyses.transient.use_initial_conditions ? network->initial : NULL);
    }
    for (int k = 0; k < 20 && status == DALCS_OK && !dalcs_grid_at_end(&e.grid); k++) {
        status = dalcs_euler_step(&e);
        if (status == DALCS_OK && e.at_jump) {
            status = dalcs_euler_cross(&e);
        }
    }
    dalcs_euler_finish(&e);
}

static void check_network(const struct dalcs_circuit *circuit, struct dalcs_diag *diag) {
    enum { MANY = 60 };
    struct dalcs_network network;
    if (circuit->n_devices > MANY ||
        dalcs_network_build(&network, circuit, &(struct dalcs_network_options){0}, diag) !=
            DALCS_OK) {
        return;
    }
    for (int k = 0; k < network.n_systems; k++) {
        check_system(&network.system[k]);
    }
    run_a_little(circuit, &network);
    run_the_default(circuit, &network);
    dalcs_network_finish(&network);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct dalcs_diag diag = {0};
    /* Other files stay closed, and a few calls inside calls must not take all memory. */
    struct dalcs_netlist netlist = {.no_includes = true, .most_cards = 2000};
    struct dalcs_circuit circuit = {0};
    require(dalcs_netlist_read_text(&netlist, "fuzz.cir", (const char *)data, size, &diag) ==
            DALCS_OK);
    require(netlist.has_errors == (diag.n_errors > 0));
    const enum dalcs_status status = dalcs_circuit_build(&circuit, &netlist, &diag);
    /* A script of .control may ask for the analysis, and --steady for one around .tran. */
    const bool is_asked = netlist.commands.n > 0 || netlist.asks.steady;
    dalcs_netlist_finish(&netlist);

    require(status == (diag.n_errors > 0 ? DALCS_E_NETLIST : DALCS_OK));
    for (size_t k = 0; k < diag.n; k++) {
        require(strlen(diag.item[k].text) > 8);
        require(k == 0 || diag.item[k].line == 0 || diag.item[k - 1].line <= diag.item[k].line);
    }
    if (status == DALCS_OK) {
        require(is_asked || has_analysis(&circuit));
        check_circuit(&circuit);
        check_network(&circuit, &diag);
    } else {
        require(circuit.arena.head == NULL && circuit.n_devices == 0);
    }
    dalcs_circuit_finish(&circuit);
    dalcs_diag_finish(&diag);
    return 0;
}
