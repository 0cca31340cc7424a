/* session.c - the life of a session: made, fed a netlist, asked for messages and the report. */
#include "orbit_analyses.h"

#include "description.h"
#include "netlist.h"
#include "number.h"
#include "source_conflicts.h"
#include "text_file.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum dalcs_status dalcs_session_create(struct dalcs_session **session) {
    *session = dalcs_alloc(1, sizeof(**session));
    if (*session == NULL) {
        return DALCS_E_NOMEM;
    }
    (*session)->patterns.most = DALCS_LU_PATTERNS_OF_RUNS;
    return DALCS_OK;
}

void dalcs_session_forget_run(struct dalcs_session *s) {
    if (s->results.recorder.network != NULL) {
        dalcs_recorder_finish(&s->results.recorder);
    }
    free(s->results.start);
    free(s->results.final);
    free(s->results.nonunique);
    s->results.start = NULL;
    s->results.final = NULL;
    s->results.nonunique = NULL;
    s->results.n_nonunique = 0;
    s->results.nonunique_capacity = 0;
    s->results.report = (struct dalcs_report){0};
    s->results.has_report = false;
}

void dalcs_session_finish_other(struct dalcs_session *other) {
    dalcs_session_forget_run(other);
    if (other->has_network) {
        dalcs_network_finish(&other->network);
    }
    if (other->has_circuit) {
        dalcs_circuit_finish(&other->circuit);
    }
    dalcs_diag_finish(&other->diag);
    dalcs_arena_finish(&other->arena);
}

void dalcs_session_destroy(struct dalcs_session *session) {
    if (session == NULL) {
        return;
    }
    dalcs_steady_anchor_forget(session);
    dalcs_session_finish_other(session);
    klu_common klu;
    dalcs_lu_common_init(&klu);
    dalcs_lu_patterns_finish(&session->patterns, &klu);
    if (session->source.has_netlist) {
        dalcs_netlist_finish(&session->source.netlist);
    }
    free(session->source.override);
    free(session->source.own);
    free(session->initial.state);
    free(session->results.document);
    dalcs_spice_names_finish(&session->results.spice);
    dalcs_arena_finish(&session->checked);
    dalcs_arena_finish(&session->audited);
    free(session);
}

/* Steps, sweeps of what is no source, and scripts need other circuits of the same netlist. */
static bool is_built_again(const struct dalcs_circuit *circuit, const struct dalcs_netlist *netlist,
                           bool is_kept) {
    bool again = circuit->analyses.n_steps > 0 || circuit->analyses.sensitivity.present ||
                 circuit->analyses.worst_case.present || netlist->commands.n > 0 || is_kept;
    for (int k = 0; k < circuit->analyses.n_dc; k++) {
        const int device = circuit->analyses.dc[k].device;
        again = again || device < 0 || circuit->device[device].stimulus < 0;
    }
    return again;
}

static enum dalcs_status read_system(struct dalcs_session *s, const char *name, const char *text,
                                     size_t length) {
    struct dalcs_description d;
    if (s->asks.transient != NULL || s->asks.transient_stop != NULL) {
        dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, "change the .tran in the file",
                       "--tran and --tstop apply to netlists, not to system files");
        return DALCS_E_OPTION;
    }
    DALCS_TRY(dalcs_description_read_text(&d, name, text, length, &s->diag));
    s->circuit = d.circuit;
    s->network = d.network;
    s->circuit.results.n_shown = d.network.n_outputs;
    s->has_circuit = true;
    s->has_network = true;
    return DALCS_OK;
}

static enum dalcs_status take_name(struct dalcs_session *s, const char *name) {
    if (s->name != NULL) {
        return DALCS_E_OPTION; /* a session reads one netlist */
    }
    s->name = dalcs_arena_copy(&s->arena, name, strlen(name));
    return s->name != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* Of a netlist that was read with this status; it is kept or finished. */
static enum dalcs_status build(struct dalcs_session *s, struct dalcs_netlist *netlist,
                               enum dalcs_status status) {
    if (status == DALCS_OK) {
        status = dalcs_circuit_build(&s->circuit, netlist, &s->diag);
        s->has_circuit = status == DALCS_OK;
    }
    if (status == DALCS_OK && is_built_again(&s->circuit, netlist, s->source.keeps_netlist)) {
        s->source.netlist = *netlist;
        s->source.has_netlist = true;
    } else {
        dalcs_netlist_finish(netlist);
    }
    if (status == DALCS_OK) {
        status = dalcs_source_conflicts(&s->circuit, &s->diag);
    }
    if (status == DALCS_OK) {
        status = dalcs_network_build(
            &s->network, &s->circuit,
            &(struct dalcs_network_options){.with_readout = dalcs_circuit_is_audited(&s->circuit)},
            &s->diag);
        s->has_network = status == DALCS_OK;
    }
    return status;
}

/* A netlist to be read, with what was asked for beside it. */
static struct dalcs_netlist asked_of(const struct dalcs_session *session) {
    return (struct dalcs_netlist){.dialect = session->dialect, .asks = session->asks};
}

enum dalcs_status dalcs_session_read_file(struct dalcs_session *session, const char *path) {
    char *text;
    size_t length;
    DALCS_TRY(take_name(session, path));
    DALCS_TRY(dalcs_text_file_read(path, INT_MAX, &text, &length, NULL, &session->diag));
    struct dalcs_netlist netlist = asked_of(session);
    const bool is_system = dalcs_description_is_text(text, length);
    const enum dalcs_status status =
        is_system ? read_system(session, path, text, length)
                  : dalcs_netlist_read_file_text(&netlist, path, text, length, &session->diag);
    free(text);
    return is_system ? status : build(session, &netlist, status);
}

enum dalcs_status dalcs_session_read_text(struct dalcs_session *session, const char *name,
                                          const char *text, size_t length) {
    DALCS_TRY(take_name(session, name));
    if (dalcs_description_is_text(text, length)) {
        return read_system(session, name, text, length);
    }
    struct dalcs_netlist netlist = asked_of(session);
    return build(session, &netlist,
                 dalcs_netlist_read_text(&netlist, name, text, length, &session->diag));
}

size_t dalcs_session_n_messages(const struct dalcs_session *session) {
    return session->diag.n;
}

size_t dalcs_session_n_events(const struct dalcs_session *session) {
    return session->results.recorder.log.n_events + session->results.recorder.log.n_events_dropped;
}

const char *dalcs_session_message(const struct dalcs_session *session, size_t index,
                                  enum dalcs_level *level) {
    static const enum dalcs_level level_of[] = {[DALCS_NOTE] = DALCS_LEVEL_NOTE,
                                                [DALCS_WARNING] = DALCS_LEVEL_WARNING,
                                                [DALCS_ERROR] = DALCS_LEVEL_ERROR};

    if (index >= session->diag.n) {
        return NULL;
    }
    if (level != NULL) {
        *level = level_of[session->diag.item[index].severity];
    }
    return session->diag.item[index].text;
}

struct dalcs_request dalcs_session_request(const struct dalcs_session *session) {
    const struct dalcs_transient *t = &session->circuit.analyses.transient;
    const struct dalcs_circuit_options *o = &session->circuit.options;
    return (struct dalcs_request){.operating_point = session->circuit.analyses.operating_point,
                                  .transient = t->present,
                                  .dc_sweep = session->circuit.analyses.n_dc > 0,
                                  .ac = session->circuit.analyses.ac.n > 0,
                                  .n_steps = dalcs_steps_count(session),
                                  .step = t->step,
                                  .stop = t->stop,
                                  .start = t->start,
                                  .max_step = t->max_step,
                                  .n_prints = (size_t)session->circuit.results.n_prints,
                                  .ascii = session->circuit.options.ascii,
                                  .periodic = session->circuit.analyses.periodic.present,
                                  .worst_case = session->circuit.analyses.worst_case.present,
                                  .euler = o->method != NULL && strcmp(o->method, "euler") == 0,
                                  .compresses = o->compress > 0.0,
                                  .transfer = session->circuit.analyses.transfer.present};
}

bool dalcs_session_print(const struct dalcs_session *session, size_t card, int analysis,
                         size_t column, struct dalcs_print *print) {
    static const int measured[] = {[DALCS_OPERATING_POINT] = DALCS_MEASURED_OP,
                                   [DALCS_TRANSIENT] = DALCS_MEASURED_TRAN,
                                   [DALCS_DC_SWEEP] = DALCS_MEASURED_DC,
                                   [DALCS_AC] = DALCS_MEASURED_AC,
                                   [DALCS_PERIODIC] = DALCS_MEASURED_TRAN};

    static const enum dalcs_print_part part[] = {
        [DALCS_PART_PLAIN] = DALCS_PRINT_PLAIN,     [DALCS_PART_MAGNITUDE] = DALCS_PRINT_MAGNITUDE,
        [DALCS_PART_DECIBEL] = DALCS_PRINT_DECIBEL, [DALCS_PART_PHASE] = DALCS_PRINT_PHASE,
        [DALCS_PART_REAL] = DALCS_PRINT_REAL,       [DALCS_PART_IMAGINARY] = DALCS_PRINT_IMAGINARY};
    const struct dalcs_circuit *circuit = &session->circuit;
    if (card >= (size_t)circuit->results.n_prints || analysis < 0 || analysis >= DALCS_N_ANALYSES) {
        return false;
    }
    if (analysis == DALCS_TRANSFER) {
        return false; /* its values are no signals */
    }
    const struct dalcs_print_card *found = &circuit->results.print[card];
    if (!found->is_of[measured[analysis]] || column >= (size_t)found->n) {
        return false;
    }
    const struct dalcs_print_column *c = &found->column[column];
    *print = (struct dalcs_print){c->signal, c->title, part[c->part]};
    return true;
}

const char *dalcs_session_measure_name(const struct dalcs_session *session, size_t index) {
    static const enum dalcs_measured_analysis in_order[] = {DALCS_MEASURED_OP, DALCS_MEASURED_DC,
                                                            DALCS_MEASURED_PSS, DALCS_MEASURED_AC,
                                                            DALCS_MEASURED_TRAN};
    const struct dalcs_circuit *circuit = &session->circuit;
    const bool asked[] = {[DALCS_MEASURED_OP] = circuit->analyses.operating_point,
                          [DALCS_MEASURED_DC] = circuit->analyses.n_dc > 0,
                          [DALCS_MEASURED_PSS] = circuit->analyses.periodic.present,
                          [DALCS_MEASURED_AC] = circuit->analyses.ac.n > 0,
                          [DALCS_MEASURED_TRAN] = circuit->analyses.transient.present};
    for (size_t a = 0; a < sizeof in_order / sizeof in_order[0]; a++) {
        for (int k = 0; asked[in_order[a]] && k < circuit->results.n_measures; k++) {
            if (circuit->results.measure[k].analysis == in_order[a] && index-- == 0) {
                return circuit->results.measure[k].name;
            }
        }
    }
    return NULL;
}

const struct dalcs_report *dalcs_session_report(const struct dalcs_session *session) {
    return session->results.has_report ? &session->results.report : NULL;
}

const struct dalcs_measurement *dalcs_session_measurement(const struct dalcs_session *session,
                                                          size_t index) {
    const bool has = session->results.has_report && index < session->results.report.n_measurements;
    return has ? &session->results.report.measurement[index] : NULL;
}

enum dalcs_status dalcs_parse_number(const char *text, double *value) {
    struct dalcs_number number;
    if (dalcs_number_parse(text, &number) != DALCS_NUMBER_OK) {
        return DALCS_E_OPTION;
    }
    *value = number.value;
    return DALCS_OK;
}
