/* messages.c - what a session has to say, as every verb prints it. */
#include "cli.h"

#include <string.h>

/* A message without a place in a file starts with what it is; the program's name goes before it. */
static bool has_place(const char *text) {
    static const char *const label[] = {"error: ", "warning: ", "note: "};
    bool bare = false;
    for (size_t i = 0; i < sizeof label / sizeof label[0] && !bare; i++) {
        bare = strncmp(text, label[i], strlen(label[i])) == 0;
    }
    return !bare;
}

void dalcs_cli_write_message(const struct dalcs_cli *cli, const char *text) {
    fprintf(cli->err, "%s%s\n", has_place(text) ? "" : "dalcs: ", text);
}

void dalcs_cli_write_messages(const struct dalcs_cli *cli, const struct dalcs_session *session,
                              size_t *n_written, bool quiet) {
    for (size_t n = dalcs_session_n_messages(session); *n_written < n; ++*n_written) {
        enum dalcs_level level = DALCS_LEVEL_NOTE;
        const char *text = dalcs_session_message(session, *n_written, &level);
        if (!quiet || level != DALCS_LEVEL_NOTE) {
            dalcs_cli_write_message(cli, text);
        }
    }
}
