/* report_reader.c - jansson does the reading; without it reports cannot be read. */
#include "report_reader.h"

#ifdef DALCS_WITH_JANSSON
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <string.h>

static enum dalcs_status refuse(struct dalcs_diag *diag, const char *path, const char *why) {
    dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "'%s' is no report of dalcs run: %s", path, why);
    return DALCS_E_OPTION;
}

static enum dalcs_status add_events(const json_t *list, const char *path,
                                    struct dalcs_conduction *conduction, struct dalcs_diag *diag) {
    size_t i;
    json_t *event;
    json_array_foreach(list, i, event) {
        const char *element = json_string_value(json_object_get(event, "element"));
        const char *state = json_string_value(json_object_get(event, "state"));
        const json_t *time = json_object_get(event, "time");
        if (!element || !state || !json_is_number(time)) {
            return refuse(diag, path, "an event has no time, element and state");
        }
        DALCS_TRY(dalcs_conduction_add(conduction, element, json_number_value(time),
                                       strcmp(state, "on") == 0));
    }
    return DALCS_OK;
}

static enum dalcs_status add_jumps(const json_t *list, struct dalcs_conduction *conduction) {
    size_t i;
    json_t *jump;
    json_array_foreach(list, i, jump) {
        DALCS_TRY(dalcs_conduction_add_jump(conduction,
                                            json_number_value(json_object_get(jump, "time"))));
    }
    return DALCS_OK;
}

static enum dalcs_status load(const char *path, json_t **report, struct dalcs_diag *diag) {
    FILE *file = fopen(path, "rb");
    if (!file) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "cannot read '%s': %s", path,
                       strerror(errno));
        return DALCS_E_IO;
    }
    json_error_t error;
    *report = json_loadf(file, 0, &error);
    fclose(file);
    if (!*report && json_error_code(&error) == json_error_out_of_memory) {
        return DALCS_E_NOMEM;
    }
    if (!*report) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "'%s' is no report of dalcs run: line %d: %s",
                       path, error.line, error.text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status add_margins(const json_t *list, bool of_phase,
                                     struct dalcs_margin_lines *lines) {
    const char *const key = of_phase ? "phase_margin" : "gain_margin";
    size_t i;
    json_t *margin;
    json_array_foreach(list, i, margin) {
        const json_t *frequency = json_object_get(margin, "frequency");
        const json_t *value = json_object_get(margin, key);
        if (json_is_number(frequency) && json_is_number(value)) {
            DALCS_TRY(dalcs_margin_lines_add(lines, of_phase, json_number_value(frequency),
                                             json_number_value(value)));
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_report_reader_margins(const char *path, struct dalcs_margin_lines *lines,
                                              struct dalcs_diag *diag) {
    json_t *report;
    DALCS_TRY(load(path, &report, diag));
    const json_t *response = json_object_get(report, "response");
    const char *loop = json_string_value(json_object_get(response, "loop"));
    enum dalcs_status status = loop ? dalcs_margin_lines_begin(lines, loop) : DALCS_OK;
    if (status == DALCS_OK && loop) {
        status = add_margins(json_object_get(response, "crossovers"), true, lines);
    }
    if (status == DALCS_OK && loop) {
        status = add_margins(json_object_get(response, "reversals"), false, lines);
    }
    json_decref(report);
    return status;
}

enum dalcs_status dalcs_report_reader_read(const char *path, struct dalcs_conduction *conduction,
                                           struct dalcs_diag *diag) {
    json_t *report;
    DALCS_TRY(load(path, &report, diag));
    const json_t *events = json_object_get(report, "events");
    enum dalcs_status status = json_is_array(events)
                                   ? add_events(events, path, conduction, diag)
                                   : refuse(diag, path, "it has no list of events");
    if (status == DALCS_OK) {
        const json_t *nodes = json_object_get(json_object_get(report, "size"), "nodes");
        conduction->of_matrices = nodes && json_integer_value(nodes) == 0;
        status = add_jumps(json_object_get(report, "jumps"), conduction);
    }
    if (status == DALCS_OK && json_object_get(report, "events_dropped")) {
        dalcs_diag_add(diag, DALCS_WARNING, NULL, NULL,
                       "'%s' does not have all events: the bars are not right after its last one",
                       path);
    }
    json_decref(report);
    return status;
}

#else

enum dalcs_status dalcs_report_reader_margins(const char *path, struct dalcs_margin_lines *lines,
                                              struct dalcs_diag *diag) {
    (void)path;
    (void)lines;
    (void)diag;
    return DALCS_OK; /* the other one says why there is none */
}

enum dalcs_status dalcs_report_reader_read(const char *path, struct dalcs_conduction *conduction,
                                           struct dalcs_diag *diag) {
    (void)conduction;
    dalcs_diag_add(diag, DALCS_ERROR, NULL,
                   "install it (on Debian: apt-get install libjansson-dev) and build again",
                   "'%s' cannot be read: this dalcs was built without the library jansson", path);
    return DALCS_E_OPTION;
}

#endif
