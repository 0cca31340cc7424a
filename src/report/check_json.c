/* check_json.c - struct dalcs_check as JSON. The keys are an interface: doc/check.schema.json. */
#include "check_json.h"

#include "json.h"

#include <math.h>

static void write_witness(struct dalcs_json *json, const struct dalcs_evidence *w) {
    dalcs_json_open(json, NULL, '{', true);
    dalcs_json_string(json, "kind", w->kind);
    if (w->n_rows > 0) {
        dalcs_json_open(json, "names", '[', false);
        for (size_t i = 0; i < w->n_rows; i++) {
            dalcs_json_string(json, NULL, w->row[i]);
        }
        dalcs_json_close(json, ']');
        dalcs_json_open(json, "matrix", '[', false);
        for (size_t i = 0; i < w->n_rows; i++) {
            dalcs_json_open(json, NULL, '[', false);
            for (size_t j = 0; j < w->n_columns; j++) {
                dalcs_json_number(json, NULL, w->value[i * w->n_columns + j]);
            }
            dalcs_json_close(json, ']');
        }
        dalcs_json_close(json, ']');
    } else {
        dalcs_json_open(json, "entries", '[', false);
        for (size_t i = 0; i < w->n_entries; i++) {
            dalcs_json_open(json, NULL, '{', false);
            dalcs_json_string(json, "name", w->entry[i].name);
            dalcs_json_number(json, "re", w->entry[i].re);
            dalcs_json_number(json, "im", w->entry[i].im);
            dalcs_json_close(json, '}');
        }
        dalcs_json_close(json, ']');
    }
    dalcs_json_close(json, '}');
}

static void write_witnesses(struct dalcs_json *json, size_t n, const struct dalcs_evidence *w) {
    dalcs_json_open(json, "witnesses", '[', false);
    for (size_t i = 0; i < n; i++) {
        write_witness(json, &w[i]);
    }
    dalcs_json_close(json, ']');
}

static void write_verdict(struct dalcs_json *json, const struct dalcs_verdict *v) {
    dalcs_json_open(json, v->question, '{', false);
    dalcs_json_string(json, "answer", dalcs_answer_text(v->answer));
    dalcs_json_string(json, "sentence", v->sentence);
    dalcs_json_string(json, "source", v->source);
    if (!isnan(v->value)) {
        dalcs_json_number(json, "value", v->value);
    }
    dalcs_json_open(json, "elements", '[', true);
    for (size_t i = 0; i < v->n_elements; i++) {
        dalcs_json_string(json, NULL, v->element[i]);
    }
    dalcs_json_close(json, ']');
    write_witnesses(json, v->n_witnesses, v->witness);
    dalcs_json_close(json, '}');
}

static void write_condition(struct dalcs_json *json, const struct dalcs_condition *c) {
    dalcs_json_open(json, NULL, '{', false);
    dalcs_json_string(json, "id", c->id);
    dalcs_json_string(json, "source", c->source);
    dalcs_json_string(json, "text", c->text);
    dalcs_json_string(json, "holds", dalcs_answer_text(c->holds));
    dalcs_json_string(json, "because", c->because);
    write_witnesses(json, c->n_witnesses, c->witness);
    dalcs_json_close(json, '}');
}

static void write_part(struct dalcs_json *json, const struct dalcs_checked_part *part) {
    dalcs_json_open(json, NULL, '{', false);
    dalcs_json_string(json, "element", part->element);
    dalcs_json_integer(json, "equal", (long)part->n_equal);
    dalcs_json_open(json, "size", '{', true);
    dalcs_json_integer(json, "states", part->states);
    dalcs_json_integer(json, "algebraic", part->algebraic);
    dalcs_json_integer(json, "diodes", part->diodes);
    dalcs_json_integer(json, "switches", part->switches);
    dalcs_json_close(json, '}');
    dalcs_json_string(json, "summary", part->summary);
    dalcs_json_open(json, "verdicts", '{', false);
    for (size_t i = 0; i < part->n_verdicts; i++) {
        write_verdict(json, &part->verdict[i]);
    }
    dalcs_json_close(json, '}');
    dalcs_json_open(json, "conditions", '[', false);
    for (size_t i = 0; i < part->n_conditions; i++) {
        write_condition(json, &part->condition[i]);
    }
    dalcs_json_close(json, ']');
    dalcs_json_close(json, '}');
}

void dalcs_check_write_json(FILE *stream, const struct dalcs_check *check) {
    struct dalcs_json json;
    dalcs_json_init(&json, stream);
    dalcs_json_open(&json, NULL, '{', false);
    dalcs_json_string(&json, "netlist", check->netlist);
    dalcs_json_string(&json, "title", check->title);
    dalcs_json_number(&json, "step", check->step);
    dalcs_json_open(&json, "parts", '[', false);
    for (size_t i = 0; i < check->n_parts; i++) {
        write_part(&json, &check->part[i]);
    }
    dalcs_json_close(&json, ']');
    dalcs_json_close(&json, '}');
}
