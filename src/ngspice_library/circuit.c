/* circuit.c - text becomes a session that takes commands. */
#include "circuit.h"

#include "lower_case.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- Lines -------------------------------------------------------------------------------------- */

static enum dalcs_status add_bytes(struct ng_lines *lines, const char *line, size_t n) {
    DALCS_TRY(dalcs_grow(&lines->text, &lines->capacity, lines->n + n + 2, 1));
    memcpy(lines->text + lines->n, line, n);
    lines->n += n;
    lines->text[lines->n++] = '\n';
    lines->text[lines->n] = '\0';
    return DALCS_OK;
}

enum dalcs_status ng_lines_add(struct ng_lines *lines, const char *line) {
    return add_bytes(lines, line, strlen(line));
}

void ng_lines_finish(struct ng_lines *lines) {
    free(lines->text);
    *lines = (struct ng_lines){0};
}

static const char *text_of(const struct ng_lines *lines) {
    return lines->text != NULL ? lines->text : "";
}

/* Does the line begin with this word, in any case? */
static bool begins(const char *line, const char *word) {
    const size_t n = strlen(word);
    line += strspn(line, " \t");
    return strncasecmp(line, word, n) == 0 &&
           (line[n] == '\0' || strchr(" \t\r\n", line[n]) != NULL);
}

static const char *next_line(const char *line) {
    line += strcspn(line, "\n");
    return *line == '\n' ? line + 1 : line;
}

bool ng_circuit_is_empty(const char *text) {
    bool is_empty = true;
    const char *line = *text != '\0' ? next_line(text) : text; /* the title */
    for (; *line != '\0' && is_empty && !begins(line, ".end"); line = next_line(line)) {
        const char first = line[strspn(line, " \t\r")];
        is_empty = first == '\n' || first == '\0' || first == '*';
    }
    return is_empty;
}

/* ---- Reading ------------------------------------------------------------------------------------ */

static enum dalcs_status split(struct ng_circuit *c, const char *text) {
    bool in_control = false;
    bool is_first = true;
    for (const char *line = text; *line != '\0'; line = next_line(line), is_first = false) {
        const size_t n = strcspn(line, "\n");
        if (!is_first && begins(line, ".end")) {
            break;
        }
        if (!is_first && begins(line, ".endc")) {
            in_control = false;
        } else if (!is_first && begins(line, ".control")) {
            in_control = true;
        } else if (!in_control) {
            DALCS_TRY(add_bytes(&c->cards, line, n));
        }
        DALCS_TRY(add_bytes(&c->source, line, n));
    }
    return DALCS_OK;
}

enum dalcs_status ng_circuit_read(struct ng_circuit **circuit, const char *name, const char *text) {
    struct ng_circuit *c = dalcs_alloc(1, sizeof *c);
    struct ng_lines all = {0};
    *circuit = c;
    if (c == NULL) {
        return DALCS_E_NOMEM;
    }
    c->is_none = text == NULL;
    c->name = dalcs_alloc(strlen(name) + 1, 1);
    enum dalcs_status status = c->name != NULL ? DALCS_OK : DALCS_E_NOMEM;
    if (status == DALCS_OK) {
        strcpy(c->name, name);
        status = split(c, text != NULL ? text : "no circuit\nr1 1 0 1\n");
    }
    /* A netlist with a script needs no analysis and takes commands. */
    status = status == DALCS_OK ? ng_lines_add(&all, text_of(&c->source)) : status;
    status = status == DALCS_OK ? ng_lines_add(&all, ".control\n* commands\n.endc\n.end") : status;
    status = status == DALCS_OK ? dalcs_session_create(&c->session) : status;
    status =
        status == DALCS_OK ? dalcs_session_read_text(c->session, name, all.text, all.n) : status;
    ng_lines_finish(&all);
    if (status == DALCS_OK && dalcs_session_input_name(c->session, 0) != NULL) {
        dalcs_session_script_message(c->session, 0, 1, 1, DALCS_LEVEL_ERROR, NULL,
                                     "'external' on a source is not supported here");
        status = DALCS_E_NETLIST; /* without a callback for its values */
    }
    const size_t n = status == DALCS_OK ? dalcs_session_n_script_lines(c->session) : 0;
    c->n_control = n > 0 ? n - 1 : 0; /* the last one is ours */
    if (status == DALCS_OK) {
        const struct dalcs_request asked = dalcs_session_request(c->session);
        c->is_asked[DALCS_OPERATING_POINT] = asked.operating_point;
        c->is_asked[DALCS_TRANSIENT] = asked.transient;
        c->is_asked[DALCS_DC_SWEEP] = asked.dc_sweep;
        c->is_asked[DALCS_AC] = asked.ac;
    }
    return status;
}

void ng_circuit_destroy(struct ng_circuit *circuit) {
    if (circuit == NULL) {
        return;
    }
    dalcs_session_destroy(circuit->session);
    ng_lines_finish(&circuit->source);
    ng_lines_finish(&circuit->cards);
    ng_lines_finish(&circuit->settings);
    for (int k = 0; k < DALCS_N_ANALYSES; k++) {
        ng_lines_finish(&circuit->run[k]);
    }
    ng_lines_finish(&circuit->made);
    free(circuit->name);
    free(circuit);
}

/* ---- What was said ------------------------------------------------------------------------------ */

static const char *const ANALYSIS[] = {[DALCS_OPERATING_POINT] = "op",
                                       [DALCS_TRANSIENT] = "tran",
                                       [DALCS_DC_SWEEP] = "dc",
                                       [DALCS_AC] = "ac"};

enum { N_WORDS = sizeof ANALYSIS / sizeof ANALYSIS[0] };

/* The analysis with all that was set for it. */
static enum dalcs_status keep_run(struct ng_circuit *c, int analysis, const char *command) {
    struct ng_lines *run = &c->run[analysis];
    ng_lines_finish(run);
    if (c->settings.n > 0) {
        DALCS_TRY(add_bytes(run, c->settings.text, c->settings.n - 1));
    }
    return ng_lines_add(run, command);
}

enum dalcs_status ng_circuit_hear(struct ng_circuit *c, const char *word, const char *rest) {
    struct ng_lines command = {0};
    const size_t n = strlen(word) + strlen(rest) + 2;
    DALCS_TRY(dalcs_grow(&command.text, &command.capacity, n, 1));
    snprintf(command.text, n, "%s %s", word, rest);
    const bool is_run = strcmp(word, "run") == 0;
    bool is_analysis = is_run;
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < N_WORDS && status == DALCS_OK; k++) {
        const bool is_it = strcmp(word, ANALYSIS[k]) == 0;
        is_analysis = is_analysis || is_it;
        if (is_it || (is_run && c->is_asked[k])) {
            status = keep_run(c, k, command.text);
        }
    }
    if (is_analysis) {
        ng_lines_finish(&c->made);
    } else if (status == DALCS_OK) {
        status = ng_lines_add(strcmp(word, "let") == 0 ? &c->made : &c->settings, command.text);
    }
    ng_lines_finish(&command);
    return status;
}

char *ng_circuit_repetition(const struct ng_circuit *c, enum dalcs_analysis analysis,
                            const char *measurement) {
    const struct ng_lines *run = &c->run[analysis];
    const size_t size = c->cards.n + run->n + c->made.n + strlen(measurement) + 64;
    char *text = run->n > 0 ? dalcs_alloc(size, 1) : NULL;
    if (text != NULL) {
        snprintf(text, size, "%s.control\n%s%smeas %s\n.endc\n.end\n", text_of(&c->cards),
                 text_of(run), text_of(&c->made), measurement);
    }
    return text;
}
