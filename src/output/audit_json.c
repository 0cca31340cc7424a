/* audit_json.c - struct dalcs_table_audit as JSON. The keys are an interface: doc/audit.schema.json. */
#include "audit_text.h"

#include "json.h"

static void write_law(struct dalcs_json *json, const struct dalcs_table_law *law) {
    dalcs_json_open(json, NULL, '{', true);
    dalcs_json_string(json, "law", law->law);
    dalcs_json_string(json, "where", law->where);
    dalcs_json_string(json, "unit", law->unit);
    dalcs_json_number(json, "defect", law->defect);
    dalcs_json_number(json, "allowed", law->allowed);
    dalcs_json_number(json, "from", law->from);
    dalcs_json_number(json, "to", law->to);
    if (law->n_broken > 0) {
        dalcs_json_number(json, "since", law->since);
    }
    if (law->sees > 0.0) {
        dalcs_json_number(json, "sees", law->sees);
    }
    dalcs_json_integer(json, "checked", (long)law->n_checked);
    dalcs_json_integer(json, "broken", (long)law->n_broken);
    dalcs_json_close(json, '}');
}

static void write_gap(struct dalcs_json *json, const struct dalcs_table_gap *gap) {
    dalcs_json_open(json, NULL, '{', true);
    dalcs_json_string(json, "law", gap->law);
    dalcs_json_string(json, "where", gap->where);
    dalcs_json_string(json, "because", gap->because);
    dalcs_json_close(json, '}');
}

void dalcs_audit_write_json(FILE *stream, const struct dalcs_table_audit *audit, const char *file) {
    struct dalcs_json json;
    dalcs_json_init(&json, stream);
    dalcs_json_open(&json, NULL, '{', false);
    dalcs_json_string(&json, "netlist", audit->netlist);
    dalcs_json_string(&json, "title", audit->title);
    dalcs_json_string(&json, "file", file);
    dalcs_json_number(&json, "tolerance", audit->tolerance);
    dalcs_json_integer(&json, "rows", (long)audit->n_rows);
    dalcs_json_integer(&json, "signals", (long)audit->n_used);
    dalcs_json_number(&json, "from", audit->from);
    dalcs_json_number(&json, "to", audit->to);
    dalcs_json_integer(&json, "broken", (long)audit->n_broken);
    dalcs_json_open(&json, "laws", '[', false);
    for (size_t i = 0; i < audit->n_laws; i++) {
        write_law(&json, &audit->law[i]);
    }
    dalcs_json_close(&json, ']');
    dalcs_json_open(&json, "not_asked", '[', false);
    for (size_t i = 0; i < audit->n_gaps; i++) {
        write_gap(&json, &audit->gap[i]);
    }
    dalcs_json_close(&json, ']');
    dalcs_json_open(&json, "foreign", '[', false);
    for (size_t i = 0; i < audit->n_foreign; i++) {
        dalcs_json_string(&json, NULL, audit->foreign[i]);
    }
    dalcs_json_close(&json, ']');
    dalcs_json_close(&json, '}');
}
