/* card_writer.c - words, names and numbers of cards; numbers with as few digits as make them distinct. */
#include "card_writer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void dalcs_write_number(FILE *f, double value) {
    char text[40];
    for (int digits = 15; digits <= 17; digits++) { /* the fewest that give the same number back */
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) {
            break;
        }
    }
    size_t point = strspn(text, "+-0123456789");
    size_t rest = point + strcspn(text + point, "+-0123456789e");
    if (isfinite(value) && rest > point) { /* whatever the locale's point is */
        text[point] = '.';
        memmove(text + point + 1, text + rest, strlen(text + rest) + 1);
    }
    fputs(text, f);
}

static bool is_plain(const char *name) {
    return name[0] != '\0' && strpbrk(name, " \t,=();$'{}") == NULL && name[0] != '"';
}

void dalcs_write_name(FILE *f, const char *name) {
    fprintf(f, is_plain(name) ? "%s" : "\"%s\"", name);
}

void dalcs_card_text(struct dalcs_card_writer *w, const char *text) {
    for (const char *p = text; *p != '\0' && w->format == DALCS_AS_JSON; p++) {
        if (*p == '"' || *p == '\\') {
            fputc('\\', w->out);
        }
        fputc(*p == '\t' ? ' ' : *p, w->out);
    }
    if (w->format != DALCS_AS_JSON) {
        fputs(text, w->out);
    }
}

void dalcs_card_begin(struct dalcs_card_writer *w, const char *word) {
    if (w->format == DALCS_AS_JSON) {
        fputs(w->first ? "\n[\"" : ",\n[\"", w->out);
        w->first = false;
    }
    dalcs_card_text(w, word);
}

void dalcs_card_between(struct dalcs_card_writer *w) {
    fputs(w->format == DALCS_AS_JSON ? "\", \"" : " ", w->out);
}

void dalcs_card_word(struct dalcs_card_writer *w, const char *word) {
    dalcs_card_between(w);
    dalcs_card_text(w, word);
}

void dalcs_card_name(struct dalcs_card_writer *w, const char *name) {
    bool quoted = !is_plain(name);
    dalcs_card_between(w);
    dalcs_card_text(w, quoted ? "\"" : "");
    dalcs_card_text(w, name);
    dalcs_card_text(w, quoted ? "\"" : "");
}

void dalcs_card_number(struct dalcs_card_writer *w, double value) {
    dalcs_card_between(w);
    dalcs_write_number(w->out, value);
}

void dalcs_card_parameter(struct dalcs_card_writer *w, const char *name, double value) {
    dalcs_card_word(w, name);
    fputc('=', w->out);
    dalcs_write_number(w->out, value);
}

void dalcs_card_unit(struct dalcs_card_writer *w, bool is_current) {
    dalcs_card_word(w, is_current ? "A" : "V");
}

void dalcs_card_end(struct dalcs_card_writer *w) {
    fputs(w->format == DALCS_AS_JSON ? "\"]" : "\n", w->out);
}
