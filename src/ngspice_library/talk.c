/* talk.c - streams and messages become lines. */
#define _GNU_SOURCE /* fopencookie */
#include "talk.h"

#include "lower_case.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

enum { LONGEST = 4000 };

/* One line, its newline not counted. */
static void send_line(struct ng_talk *talk, const char *stream, const char *text, size_t n) {
    char line[LONGEST];
    ng_send_char *send = talk->send_char;
    if (send != NULL) {
        snprintf(line, sizeof line, "%s %.*s", stream, (int)(n < LONGEST ? n : LONGEST - 1), text);
        send(line, talk->id, talk->user);
    }
}

static void send_lines(struct ng_talk *talk, const char *stream, const char *text) {
    while (*text != '\0') {
        const size_t n = strcspn(text, "\n");
        send_line(talk, stream, text, n);
        text += n + (text[n] == '\n');
    }
}

/* What is printed: lines go on as they are complete. */
static ssize_t take(void *cookie, const char *text, size_t size) {
    struct ng_talk *talk = cookie;
    for (size_t k = 0; k < size; k++) {
        if (text[k] == '\n') {
            send_line(talk, "stdout", talk->line != NULL ? talk->line : "", talk->n);
            talk->n = 0;
        } else if (dalcs_grow(&talk->line, &talk->capacity, talk->n + 1, 1) == DALCS_OK) {
            talk->line[talk->n++] = text[k];
        }
    }
    return (ssize_t)size;
}

enum dalcs_status ng_talk_open(struct ng_talk *talk) {
    talk->out = fopencookie(talk, "w", (cookie_io_functions_t){.write = take});
    if (talk->out == NULL) {
        return DALCS_E_NOMEM;
    }
    setvbuf(talk->out, NULL, _IOLBF, BUFSIZ);
    return DALCS_OK;
}

void ng_talk_close(struct ng_talk *talk) {
    if (talk->out != NULL) {
        fclose(talk->out);
    }
    free(talk->line);
    talk->out = NULL;
    talk->line = NULL;
    talk->n = talk->capacity = 0;
}

static void send_formatted(struct ng_talk *talk, const char *stream, const char *head,
                           const char *format, va_list arguments) {
    char text[LONGEST];
    const int n = snprintf(text, sizeof text, "%s", head);
    vsnprintf(text + n, sizeof text - (size_t)n, format, arguments);
    send_lines(talk, stream, text);
}

void ng_talk_say(struct ng_talk *talk, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    send_formatted(talk, "stdout", "", format, arguments);
    va_end(arguments);
}

void ng_talk_fail(struct ng_talk *talk, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    send_formatted(talk, "stderr", "Error: ", format, arguments);
    va_end(arguments);
}

void ng_talk_warn(struct ng_talk *talk, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    send_formatted(talk, "stderr", "Warning: ", format, arguments);
    va_end(arguments);
}

/* ---- Messages of a session ------------------------------------------------------------------------- */

/* Without the label that says what it is, and for what is no error without the words that programs look for. */
static void soften(char *text) {
    static const char *const word[][2] = {{"error", "fault"}, {"warning", "caution"}};
    for (char *at = text; *at != '\0'; at++) {
        for (size_t k = 0; k < sizeof word / sizeof word[0]; k++) {
            size_t n = 0;
            while (word[k][0][n] != '\0' && dalcs_lower(at[n]) == word[k][0][n]) {
                n++;
            }
            if (word[k][0][n] == '\0') { /* as many letters: what a caret points at stays there */
                memcpy(at, word[k][1], n);
            }
        }
    }
}

/* "file:1:2: error: text" -> "file:1:2: text", in place. */
static void cut_label(char *text) {
    static const char *const label[] = {"error: ", "warning: ", "note: "};
    char *first = NULL;
    size_t length = 0;
    for (size_t k = 0; k < sizeof label / sizeof label[0]; k++) {
        char *at = strstr(text, label[k]);
        if (at != NULL && (first == NULL || at < first)) {
            first = at;
            length = strlen(label[k]);
        }
    }
    if (first != NULL && first < text + strcspn(text, "\n")) {
        memmove(first, first + length, strlen(first + length) + 1);
    }
}

static void send_message(struct ng_talk *talk, enum dalcs_level level, const char *message) {
    char text[LONGEST];
    const bool is_error = level == DALCS_LEVEL_ERROR;
    const int n = snprintf(text, sizeof text, "%s", is_error ? "Error: " : "Note: ");
    snprintf(text + n, sizeof text - (size_t)n, "%s", message);
    cut_label(text + n);
    if (!is_error) {
        soften(text);
    }
    send_lines(talk, is_error ? "stderr" : "stdout", text);
}

size_t ng_talk_messages(struct ng_talk *talk, const struct dalcs_session *session, size_t *n_told) {
    size_t n_errors = 0;
    for (const size_t n = dalcs_session_n_messages(session); *n_told < n; ++*n_told) {
        enum dalcs_level level = DALCS_LEVEL_NOTE;
        const char *message = dalcs_session_message(session, *n_told, &level);
        n_errors += level == DALCS_LEVEL_ERROR;
        send_message(talk, level, message);
    }
    return n_errors;
}
