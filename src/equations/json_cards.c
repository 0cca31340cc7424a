/* json_cards.c - the JSON form of a system file as cards: what json.org calls an object has the cards of
 * the run, then networks of systems, each with its cards and matrices.
 *
 * Read by jansson, which is optional. */
#include "equations.h"
#include "reading.h"

#include <stdio.h>
#include <stdlib.h>

#ifdef DALCS_WITH_JANSSON

#include <jansson.h>

struct conversion {
    FILE *out;
    bool failed;
};

/* ["state", "c1", "V"]: words as they stand on a card. */
static void write_cards(struct conversion *c, const json_t *cards) {
    size_t k;
    size_t i;
    json_t *card;
    json_t *word;
    if (cards != NULL && !json_is_array(cards)) {
        c->failed = true;
        return;
    }
    json_array_foreach(cards, k, card) {
        c->failed = c->failed || !json_is_array(card);
        json_array_foreach(card, i, word) {
            if (json_is_string(word)) {
                fprintf(c->out, "%s%s", i > 0 ? " " : "", json_string_value(word));
            } else {
                c->failed = true;
            }
        }
        fputc('\n', c->out);
    }
}

/* {"rows": [...], "columns": [...], "values": [...]}, counted from 1 */
static void write_matrix(struct conversion *c, const char *name, const json_t *matrix) {
    const json_t *part[3] = {json_object_get(matrix, "row"), json_object_get(matrix, "column"),
                             json_object_get(matrix, "value")};
    size_t n = json_array_size(part[2]);
    fprintf(c->out, "matrix %s sparse\n", name);
    for (int p = 0; p < 3; p++) {
        c->failed = c->failed || !json_is_array(part[p]) || json_array_size(part[p]) != n;
    }
    for (size_t k = 0; k < n && !c->failed; k++) {
        const json_t *entry[3];
        for (int p = 0; p < 3; p++) {
            entry[p] = json_array_get(part[p], k);
        }
        c->failed =
            !json_is_integer(entry[0]) || !json_is_integer(entry[1]) || !json_is_number(entry[2]);
        fprintf(c->out, "+ %lld %lld ", (long long)json_integer_value(entry[0]),
                (long long)json_integer_value(entry[1]));
        dalcs_write_number(c->out, json_number_value(entry[2]));
        fputc('\n', c->out);
    }
}

static void write_system(struct conversion *c, const json_t *system) {
    const char *name;
    json_t *matrix;
    c->failed = c->failed || !json_is_object(system);
    fputs("system\n", c->out);
    write_cards(c, json_object_get(system, "cards"));
    json_object_foreach(json_object_get(system, "matrices"), name, matrix) {
        write_matrix(c, name, matrix);
    }
}

static void write_all(struct conversion *c, const json_t *root) {
    size_t k;
    size_t i;
    json_t *network;
    json_t *system;
    const char *title = json_string_value(json_object_get(root, "title"));
    fprintf(c->out, "dalcs-system 2 %s\n", title == NULL ? "" : title);
    c->failed = json_integer_value(json_object_get(root, "dalcs-system")) != 2 || title == NULL;
    write_cards(c, json_object_get(root, "cards"));
    json_array_foreach(json_object_get(root, "networks"), k, network) {
        const char *name = json_string_value(json_object_get(network, "name"));
        c->failed = c->failed || name == NULL;
        fprintf(c->out, "network %s\n", name == NULL ? "" : name);
        json_array_foreach(json_object_get(network, "systems"), i, system) {
            write_system(c, system);
        }
        write_cards(c, json_object_get(network, "cards"));
    }
}

enum dalcs_status dalcs_json_to_cards(const char *name, const char *text, size_t length,
                                      char **cards, size_t *n, struct dalcs_diag *diag) {
    json_error_t error;
    *cards = NULL;
    *n = 0;
    json_t *root = json_loadb(text, length, JSON_REJECT_DUPLICATES, &error);
    if (root == NULL) {
        const struct dalcs_location where = {
            .file = name, .line = error.line, .column = error.column, .length = 1};
        dalcs_diag_add(diag, DALCS_ERROR, &where, NULL, "this is not JSON: %s", error.text);
        return json_error_code(&error) == json_error_out_of_memory ? DALCS_E_NOMEM
                                                                   : DALCS_E_NETLIST;
    }
    struct conversion c = {.out = open_memstream(cards, n)};
    enum dalcs_status status = c.out == NULL ? DALCS_E_NOMEM : DALCS_OK;
    if (status == DALCS_OK) {
        write_all(&c, root);
        bool lost = ferror(c.out) != 0;
        lost = fclose(c.out) != 0 || lost || *cards == NULL;
        status = lost ? DALCS_E_NOMEM : c.failed ? DALCS_E_NETLIST : DALCS_OK;
    }
    if (status == DALCS_E_NETLIST) {
        const struct dalcs_location where = {.file = name};
        dalcs_diag_add(diag, DALCS_ERROR, &where, "doc/system-file.md shows the form",
                       "%s: this JSON is not that of a system", name);
    }
    json_decref(root);
    return status;
}

#else

enum dalcs_status dalcs_json_to_cards(const char *name, const char *text, size_t length,
                                      char **cards, size_t *n, struct dalcs_diag *diag) {
    const struct dalcs_location where = {.file = name};
    (void)text;
    (void)length;
    *cards = NULL;
    *n = 0;
    dalcs_diag_add(diag, DALCS_ERROR, &where, "write the text form: --format system",
                   "%s: this program was built without jansson and reads no JSON", name);
    return DALCS_E_NETLIST;
}

#endif
