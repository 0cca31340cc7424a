/* check_netlist.c - reads a netlist as far as its equations, prints the messages on stderr.
 *
 *     check_netlist FILE [NAME]     with NAME: as text, which messages call NAME
 *     check_netlist --each FILE...  one after the other
 *
 * Exit status 0, 3 for a netlist with errors, 4 for a file that cannot be read, as the program. With --each errors of netlists are none. */
#include "dalcs.h"
#include "memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* Not static, so that a profiler finds its calls. */
int check_netlist(const char *path, const char *name);

__attribute__((noinline)) int check_netlist(const char *path, const char *name) {
    size_t length;
    char *text = read_all(path, &length);
    if (text == NULL) {
        return 4;
    }
    struct dalcs_session *session = NULL;
    enum dalcs_status status = dalcs_session_create(&session);
    if (status == DALCS_OK) {
        status = name != NULL ? dalcs_session_read_text(session, name, text, length)
                              : dalcs_session_read_file(session, path);
    }
    for (size_t k = 0; session != NULL && k < dalcs_session_n_messages(session); k++) {
        fprintf(stderr, "%s\n", dalcs_session_message(session, k, NULL));
    }
    dalcs_session_destroy(session);
    free(text);
    return status == DALCS_OK ? 0 : status == DALCS_E_NETLIST ? 3 : 1;
}

int main(int argc, char **argv) {
    if (argc < 2) {
        fprintf(stderr, "usage: check_netlist FILE [NAME]\n       check_netlist --each FILE...\n");
        return 2;
    }
    if (strcmp(argv[1], "--each") != 0) {
        return check_netlist(argv[1], argc > 2 ? argv[2] : NULL);
    }
    for (int k = 2; k < argc; k++) {
        int status = check_netlist(argv[k], NULL);
        if (status != 0 && status != 3) {
            return status;
        }
    }
    return 0;
}
