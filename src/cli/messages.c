/* messages.c - what a session has to say, as every verb prints it.
 *
 * Of warnings and notes that differ in the names between quotes alone, as of many elements, the first are printed; the
 * others are counted, in a line behind what came with them. Errors are printed all. */
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

/* Messages of one kind that are printed. */
enum { MOST_OF_A_KIND = 3 };

/* The sentence of a message, behind its place and its label. */
static const char *sentence_of(const char *text) {
    static const char *const label[] = {"warning: ", "note: "};
    const char *found = text;
    for (size_t i = 0; i < sizeof label / sizeof label[0] && found == text; i++) {
        const char *at = strstr(text, label[i]);
        const char *end = strchr(text, '\n');
        found = at != NULL && (end == NULL || at < end) ? at + strlen(label[i]) : text;
    }
    return found;
}

/* Behind the name that begins here between quotes. */
static const char *skip_name(const char *quote) {
    const char *end = quote + 1;
    while (*end != '\0' && *end != '\n' && *end != '\'') {
        end++;
    }
    return *end == '\'' ? end + 1 : quote + 1;
}

/* Does a name begin here? An apostrophe stands behind a letter. */
static bool begins_name(const char *sentence, const char *at) {
    return *at == '\'' && (at == sentence || at[-1] == ' ' || at[-1] == '(');
}

/* Are the sentences the same but for names? */
static bool is_like(const char *a, const char *b) {
    const char *const sentence = sentence_of(a);
    a = sentence;
    b = sentence_of(b);
    while (*a == *b && *a != '\0' && *a != '\n') {
        const bool is_name = begins_name(sentence, a);
        a = is_name ? skip_name(a) : a + 1;
        b = is_name ? skip_name(b) : b + 1;
    }
    return (*a == '\0' || *a == '\n') && (*b == '\0' || *b == '\n');
}

/* Counts the messages like number `index` between `first` and it. */
static size_t count_like(const struct dalcs_session *session, size_t first, size_t index) {
    enum dalcs_level level = DALCS_LEVEL_NOTE;
    const char *text = dalcs_session_message(session, index, &level);
    size_t n = 0;
    for (size_t k = first; k < index; k++) {
        enum dalcs_level other = DALCS_LEVEL_NOTE;
        const char *before = dalcs_session_message(session, k, &other);
        n += other == level && is_like(before, text) ? 1 : 0;
    }
    return n;
}

/* One line for each kind of the messages from `first` on of which some were not printed. */
static void write_rest(const struct dalcs_cli *cli, const struct dalcs_session *session,
                       size_t first, size_t end, bool quiet) {
    for (size_t k = end; k-- > first;) {
        enum dalcs_level level = DALCS_LEVEL_NOTE;
        const char *text = dalcs_session_message(session, k, &level);
        size_t later = 0;
        for (size_t j = k + 1; j < end && later == 0; j++) {
            enum dalcs_level other = DALCS_LEVEL_NOTE;
            const char *behind = dalcs_session_message(session, j, &other);
            later += other == level && is_like(text, behind) ? 1 : 0;
        }
        const size_t before = count_like(session, 0, k);
        if (later > 0 || before < MOST_OF_A_KIND || level == DALCS_LEVEL_ERROR ||
            (quiet && level == DALCS_LEVEL_NOTE)) {
            continue; /* only the last one of its kind is shown */
        }
        const size_t here = count_like(session, first, k) + 1;
        const size_t printed = before + 1 - here;
        const size_t left = printed < MOST_OF_A_KIND ? MOST_OF_A_KIND - printed : 0;
        const char *sentence = sentence_of(text);
        fprintf(cli->err, "dalcs: %s: and %zu more of this kind: %.*s\n",
                level == DALCS_LEVEL_NOTE ? "note" : "warning", here - left,
                (int)strcspn(sentence, "\n"), sentence);
    }
}

void dalcs_cli_write_messages(const struct dalcs_cli *cli, const struct dalcs_session *session,
                              size_t *n_written, bool quiet) {
    const size_t first = *n_written;
    const size_t n = dalcs_session_n_messages(session);
    for (; *n_written < n; ++*n_written) {
        enum dalcs_level level = DALCS_LEVEL_NOTE;
        const char *text = dalcs_session_message(session, *n_written, &level);
        const bool is_folded =
            level != DALCS_LEVEL_ERROR && count_like(session, 0, *n_written) >= MOST_OF_A_KIND;
        if (!is_folded && (!quiet || level != DALCS_LEVEL_NOTE)) {
            dalcs_cli_write_message(cli, text);
        }
    }
    write_rest(cli, session, first, n, quiet);
}
