/* check_netlist.c - reads a netlist as far as its equations, prints the messages on stderr.
 *
 *     check_netlist FILE [NAME]     with NAME: as text, which messages call NAME
 *
 * Exit status 0, 3 for a netlist with errors, 4 for a file that cannot be read, as the program. */
#include "dalcs.h"
#include "memory.h"

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
    struct dalcs_session *session = NULL;
    enum dalcs_status status = dalcs_session_create(&session);
    if (status == DALCS_OK) {
        status = argc > 2 ? dalcs_session_read_text(session, argv[2], text, length)
                          : dalcs_session_read_file(session, argv[1]);
    }
    for (size_t k = 0; session != NULL && k < dalcs_session_n_messages(session); k++) {
        fprintf(stderr, "%s\n", dalcs_session_message(session, k, NULL));
    }
    dalcs_session_destroy(session);
    free(text);
    return status == DALCS_OK ? 0 : status == DALCS_E_NETLIST ? 3 : 1;
}
