/* write_system.c - a network for machines: the cards of a system file, or the same as JSON, or with the
 * matrices as Matrix Market files beside it. What is read back is what was written, to the bit. */
#include "card_writer.h"

#include "impulse_network.h"

#include <stdlib.h>

static void put_stimulus(struct dalcs_card_writer *w, const struct dalcs_stimulus *s) {
    dalcs_card_between(w);
    dalcs_write_stimulus(w->out, s);
}

/* ---- Systems ------------------------------------------------------------------------------- */

static const char *const kind_name[] = {[DALCS_LABEL_STATE] = "kind=state",
                                        [DALCS_LABEL_NODE] = "kind=node",
                                        [DALCS_LABEL_BRANCH] = "kind=branch",
                                        [DALCS_LABEL_REFERENCE] = "kind=reference"};

static void put_columns(struct dalcs_card_writer *w, const struct dalcs_system *s,
                        const double *initial) {
    for (int c = 0; c < dalcs_system_n_equations(s); c++) {
        bool is_state = c < s->n_x;
        dalcs_card_begin(w, is_state ? "state" : "unknown");
        dalcs_card_name(w, s->column[c].element);
        dalcs_card_unit(w, s->column_is_current[c]);
        if (is_state && initial != NULL) {
            dalcs_card_number(w, initial[c]);
        }
        if (s->column[c].kind != (is_state ? DALCS_LABEL_STATE : DALCS_LABEL_BRANCH)) {
            dalcs_card_word(w, kind_name[s->column[c].kind]);
        }
        if (s->forest_root[c] != c) {
            dalcs_card_parameter(w, "root", s->forest_root[c] + 1);
        }
        dalcs_card_end(w);
    }
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        dalcs_card_begin(w, "row");
        dalcs_card_name(w, s->row[r].element);
        dalcs_card_unit(w, s->row_is_current[r]);
        if (s->row[r].kind != DALCS_LABEL_BRANCH) {
            dalcs_card_word(w, kind_name[s->row[r].kind]);
        }
        dalcs_card_parameter(w, "dual", s->dual[r] + 1);
        dalcs_card_end(w);
    }
}

static void put_pairs(struct dalcs_card_writer *w, const struct dalcs_system *s) {
    for (int d = 0; d < s->n_pairs; d++) {
        const struct dalcs_pair *p = &s->pair[d];
        bool is_switch = p->kind == DALCS_PAIR_SWITCH;
        dalcs_card_begin(w, is_switch         ? "switch"
                            : p->is_breakdown ? "reverse"
                            : p->is_formula   ? "corner"
                                              : "pair");
        dalcs_card_name(w, p->element);
        if (is_switch) {
            dalcs_card_parameter(w, "on", p->turn_on);
            dalcs_card_parameter(w, "off", p->turn_off);
            if (p->has_valve) {
                dalcs_card_parameter(w, "valve", p->valve + 1);
            }
        }
        if (p->initially_on) {
            dalcs_card_word(w, "closed");
        }
        if (p->is_direct) {
            dalcs_card_word(w, "direct");
        }
        dalcs_card_end(w);
    }
}

static void put_system(struct dalcs_card_writer *w, const struct dalcs_system *s,
                       const double *initial, bool jumps_are_covered) {
    if (w->format == DALCS_AS_JSON) {
        fputs(w->first ? "\n{\"cards\": [" : ",\n{\"cards\": [", w->out);
        w->first = true;
    } else {
        fputs("system\n", w->out);
    }
    dalcs_card_begin(w, "monotone");
    dalcs_card_word(w, s->monotone ? "yes" : "no");
    dalcs_card_end(w);
    if (jumps_are_covered) {
        dalcs_card_begin(w, "jumps_are_covered");
        dalcs_card_end(w);
    }
    dalcs_card_begin(w, "inputs");
    for (int k = 1; k < s->n_inputs; k++) {
        dalcs_card_name(w, s->input_element[k]);
    }
    dalcs_card_end(w);
    put_columns(w, s, initial);
    put_pairs(w, s);
    if (w->format == DALCS_AS_JSON) {
        fputs("],\n\"matrices\": {", w->out);
        w->first = true;
    }
    dalcs_card_matrices(w, s);
    if (w->format == DALCS_AS_JSON) {
        fputs("}}", w->out);
        w->first = false;
    }
}

/* ---- Outputs ------------------------------------------------------------------------------- */

static void put_probe(struct dalcs_card_writer *w, const struct dalcs_probe *p) {
    dalcs_card_word(w, "in");
    dalcs_card_number(w, p->system + 1);
    for (int k = 0; k < p->n_terms + p->n_inputs; k++) {
        char reference[24];
        bool is_input = k >= p->n_terms;
        snprintf(reference, sizeof reference, "%c%d", is_input ? '@' : '#',
                 p->term[k].index + (is_input ? 0 : 1));
        dalcs_card_word(w, reference);
        dalcs_card_number(w, p->term[k].coefficient);
    }
}

static void put_outputs(struct dalcs_card_writer *w, const struct dalcs_network *n) {
    for (int i = 0; i < n->n_outputs; i++) {
        const struct dalcs_output *out = &n->output[i];
        dalcs_card_begin(w, "output");
        dalcs_card_name(w, out->name);
        dalcs_card_unit(w, out->is_current);
        if (out->plus.system >= 0) {
            put_probe(w, &out->plus);
        }
        if (out->minus.system >= 0) {
            dalcs_card_word(w, "minus");
            put_probe(w, &out->minus);
        }
        dalcs_card_end(w);
    }
    for (int i = 0; i < n->n_states; i++) {
        const struct dalcs_state *state = &n->state[i];
        dalcs_card_begin(w, "element");
        dalcs_card_name(w, state->element);
        dalcs_card_unit(w, state->is_current);
        if (state->probe.system >= 0) {
            put_probe(w, &state->probe);
        }
        dalcs_card_end(w);
    }
}

static void put_network(struct dalcs_card_writer *w, const char *name,
                        const struct dalcs_network *n, bool with_initial, const bool *covered) {
    if (w->format == DALCS_AS_JSON) {
        fprintf(w->out, "%s\n{\"name\": \"%s\", \"systems\": [", w->first ? "" : ",", name);
    } else {
        fprintf(w->out, "network %s\n", name);
    }
    w->first = true;
    for (int k = 0; k < n->n_systems; k++) {
        put_system(w, &n->system[k], with_initial ? n->initial[k] : NULL,
                   covered != NULL && covered[k]);
    }
    if (w->format == DALCS_AS_JSON) {
        fputs("],\n\"cards\": [", w->out);
        w->first = true;
    }
    put_outputs(w, n);
    if (w->format == DALCS_AS_JSON) {
        fputs("]}", w->out);
        w->first = false;
    }
}

/* ---- What is asked for ---------------------------------------------------------------------- */

static void put_analyses(struct dalcs_card_writer *w, const struct dalcs_circuit *c) {
    const struct dalcs_transient *t = &c->analyses.transient;
    if (c->analyses.operating_point) {
        dalcs_card_begin(w, ".op");
        dalcs_card_end(w);
    }
    if (t->present) {
        dalcs_card_begin(w, ".tran");
        dalcs_card_number(w, t->step);
        dalcs_card_number(w, t->stop);
        if (t->start > 0.0 || t->max_step > 0.0) {
            dalcs_card_number(w, t->start);
        }
        if (t->max_step > 0.0) {
            dalcs_card_number(w, t->max_step);
        }
        if (t->use_initial_conditions) {
            dalcs_card_word(w, "uic");
        }
        dalcs_card_end(w);
    }
}

static void put_option(struct dalcs_card_writer *w, const char *name, double value) {
    if (value != 0.0) {
        dalcs_card_begin(w, ".options");
        dalcs_card_parameter(w, name, value);
        dalcs_card_end(w);
    }
}

static void put_options(struct dalcs_card_writer *w, const struct dalcs_circuit_options *o) {
    put_option(w, "reltol", o->reltol);
    put_option(w, "abstol", o->abstol);
    put_option(w, "vntol", o->vntol);
    put_option(w, "step", o->step);
    put_option(w, "stages", o->stages);
    put_option(w, "compress", o->compress);
    if (o->method != NULL) {
        dalcs_card_begin(w, ".options");
        dalcs_card_word(w, "method=");
        dalcs_card_text(w, o->method);
        dalcs_card_end(w);
    }
}

static void put_inputs(struct dalcs_card_writer *w, const struct dalcs_equations *e) {
    const struct dalcs_network *n = e->network;
    for (int i = 0; i < e->circuit->n_stimuli; i++) {
        const char *name = NULL;
        for (int k = 0; k < n->n_systems && name == NULL; k++) {
            for (int u = 1; u < n->system[k].n_inputs && name == NULL; u++) {
                name = n->system[k].stimulus[u] == i ? n->system[k].input_element[u] : NULL;
            }
        }
        for (int d = 0; d < e->circuit->n_devices && name == NULL; d++) {
            name = e->circuit->device[d].stimulus == i ? e->circuit->device[d].name : NULL;
        }
        if (name == NULL) {
            continue;
        }
        dalcs_card_begin(w, "input");
        dalcs_card_name(w, name);
        put_stimulus(w, &e->circuit->stimulus[i]);
        dalcs_card_end(w);
    }
}

static void put_head(struct dalcs_card_writer *w, const struct dalcs_equations *e) {
    if (w->format == DALCS_AS_JSON) {
        fputs("{\"dalcs-system\": 2,\n\"title\": \"", w->out);
        dalcs_card_text(w, e->circuit->title);
        fputs("\",\n\"cards\": [", w->out);
        w->first = true;
    } else {
        fprintf(w->out, "dalcs-system 2 %s\n", e->circuit->title);
    }
    put_analyses(w, e->circuit);
    put_options(w, &e->circuit->options);
    put_inputs(w, e);
    if (w->format == DALCS_AS_JSON) {
        fputs("],\n\"networks\": [", w->out);
        w->first = true;
    }
}

static void put_all(struct dalcs_card_writer *w, const struct dalcs_equations *e) {
    const struct dalcs_network *n = e->network;
    put_head(w, e);
    put_network(w, "main", n, e->circuit->analyses.transient.use_initial_conditions,
                e->jumps_are_covered);
    static const char *const name[] = {
        [DALCS_IMPULSE_CHARGE] = "charge", [DALCS_IMPULSE_FLUX] = "flux"};
    for (int kind = 0; kind < DALCS_N_IMPULSES; kind++) {
        if (e->jump[kind] != NULL) {
            put_network(w, name[kind], e->jump[kind], false, NULL);
        }
    }
    if (e->held != NULL) {
        put_network(w, "held", e->held, false, NULL);
    }
    fputs(w->format == DALCS_AS_JSON ? "]}\n" : ".end\n", w->out);
}

enum dalcs_status dalcs_equations_write_system(const struct dalcs_equations *equations,
                                               enum dalcs_machine_format format,
                                               const struct dalcs_equations_files *files) {
    char *text = NULL;
    size_t length;
    struct dalcs_card_writer w = {.format = format, .files = files};
    w.out = open_memstream(&text, &length);
    if (w.out == NULL) {
        return DALCS_E_NOMEM;
    }
    put_all(&w, equations);
    bool lost = ferror(w.out) != 0;
    lost = fclose(w.out) != 0 || lost || text == NULL;
    w.status = w.status == DALCS_OK && lost ? DALCS_E_NOMEM : w.status;
    if (w.status == DALCS_OK) {
        w.status = files->file(files->user, "", text, length);
    }
    free(text);
    return w.status;
}
