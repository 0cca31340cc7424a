/* ngspice_raw.c - a text header, then doubles point after point. */
#include "ngspice_raw.h"

#include "memory.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_LINE = 4096 };

/* "\t2\tv(out)\tvoltage": the third part. */
static enum dalcs_status add_name(struct dalcs_ngspice_raw *raw, size_t k, char *line) {
    strtok(line, "\t\n");
    const char *name = strtok(NULL, "\t\n");
    raw->name[k] = name ? strdup(name) : NULL;
    return !name ? DALCS_E_IO : raw->name[k] ? DALCS_OK : DALCS_E_NOMEM;
}

/* Up to the first byte of the values. */
static enum dalcs_status read_header(struct dalcs_ngspice_raw *raw, FILE *file) {
    char line[MAX_LINE];
    while (fgets(line, sizeof line, file)) {
        if (strncmp(line, "Flags:", 6) == 0 && !strstr(line, "real")) {
            return DALCS_E_IO;
        }
        if (strncmp(line, "No. Variables:", 14) == 0) {
            raw->n_columns = strtoul(line + 14, NULL, 10);
        } else if (strncmp(line, "Variables:", 10) == 0 && raw->n_columns > 0) {
            raw->name = dalcs_alloc(raw->n_columns, sizeof *raw->name);
            enum dalcs_status status = raw->name ? DALCS_OK : DALCS_E_NOMEM;
            for (size_t k = 0; k < raw->n_columns && status == DALCS_OK; k++) {
                status = fgets(line, sizeof line, file) ? add_name(raw, k, line) : DALCS_E_IO;
            }
            if (status != DALCS_OK) {
                return status;
            }
        } else if (strncmp(line, "Binary:", 7) == 0) {
            return raw->name ? DALCS_OK : DALCS_E_IO;
        }
    }
    return DALCS_E_IO;
}

static enum dalcs_status read_values(struct dalcs_ngspice_raw *raw, FILE *file) {
    long from = ftell(file);
    if (from < 0 || fseek(file, 0, SEEK_END) != 0) {
        return DALCS_E_IO;
    }
    long to = ftell(file);
    if (to < from || fseek(file, from, SEEK_SET) != 0) {
        return DALCS_E_IO;
    }
    raw->n_points = (size_t)(to - from) / (raw->n_columns * sizeof(double));
    raw->value = dalcs_alloc(raw->n_points * raw->n_columns, sizeof *raw->value);
    if (!raw->value) {
        return DALCS_E_NOMEM;
    }
    size_t n = raw->n_points * raw->n_columns;
    return fread(raw->value, sizeof *raw->value, n, file) == n ? DALCS_OK : DALCS_E_IO;
}

enum dalcs_status dalcs_ngspice_raw_read(struct dalcs_ngspice_raw *raw, const char *path) {
    *raw = (struct dalcs_ngspice_raw){0};
    FILE *file = fopen(path, "rb");
    if (!file) {
        return DALCS_E_IO;
    }
    enum dalcs_status status = read_header(raw, file);
    if (status == DALCS_OK) {
        status = read_values(raw, file);
    }
    fclose(file);
    if (status != DALCS_OK) {
        dalcs_ngspice_raw_finish(raw);
    }
    return status;
}

size_t dalcs_ngspice_raw_find(const struct dalcs_ngspice_raw *raw, const char *name) {
    size_t k = 0;
    while (k < raw->n_columns && strcasecmp(raw->name[k], name) != 0) {
        k++;
    }
    return k;
}

void dalcs_ngspice_raw_finish(struct dalcs_ngspice_raw *raw) {
    for (size_t k = 0; raw->name && k < raw->n_columns; k++) {
        free(raw->name[k]);
    }
    free(raw->name);
    free(raw->value);
    *raw = (struct dalcs_ngspice_raw){0};
}
