/* check_netlist.c - reads a netlist, builds its circuit, prints the messages on stderr.
 *
 *     check_netlist FILE [NAME]     messages call the file NAME
 *
 * Exit status 0, 3 for a netlist with errors, 4 for a file that cannot be read, as the program. */
#include "circuit.h"
#include "netlist.h"

#include <stdio.h>
#include <stdlib.h>

/* The whole file; NULL when it cannot be read. */
static char *read_all(const char *path, size_t *length) {
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    size_t capacity = 0;
    size_t got = 1;
    *length = 0;
    while (file != NULL && got > 0 && dalcs_grow(&text, &capacity, *length + 4096, 1) == DALCS_OK) {
        got = fread(text + *length, 1, capacity - *length, file);
        *length += got;
    }
    if (file != NULL) {
        fclose(file);
    }
    return text;
}

int main(int argc, char **argv) {
    if (argc < 2) {
        fprintf(stderr, "usage: check_netlist FILE [NAME]\n");
        return 2;
    }
    size_t length;
    char *text = read_all(argv[1], &length);
    if (text == NULL) {
        return 4;
    }
    struct dalcs_diag diag = {0};
    struct dalcs_netlist netlist = {0};
    struct dalcs_circuit circuit = {0};
    enum dalcs_status status =
        dalcs_netlist_read_text(&netlist, argc > 2 ? argv[2] : argv[1], text, length, &diag);
    if (status == DALCS_OK) {
        status = dalcs_circuit_build(&circuit, &netlist, &diag);
    }
    dalcs_netlist_finish(&netlist);
    for (size_t k = 0; k < diag.n; k++) {
        fprintf(stderr, "%s\n", diag.item[k].text);
    }
    dalcs_diag_finish(&diag);
    dalcs_circuit_finish(&circuit);
    free(text);
    return status == DALCS_OK ? 0 : status == DALCS_E_NETLIST ? 3 : 1;
}
