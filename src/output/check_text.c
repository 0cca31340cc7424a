/* check_text.c - the check on a screen: plain words first, numbers and sources after. */
#include "check_text.h"

#include <string.h>

enum { WIDTH = 96 };

/* Text at an indentation, broken at blanks. */
static void write_wrapped(FILE *stream, int indent, int column, const char *text) {
    while (*text != '\0') {
        const size_t word = strcspn(text, " ");
        if (column > indent && column + 1 + (int)word > WIDTH) {
            fprintf(stream, "\n%*s", indent, "");
            column = indent;
        } else if (column > indent) {
            fputc(' ', stream);
            column++;
        }
        fwrite(text, 1, word, stream);
        column += (int)word;
        text += word + strspn(text + word, " ");
    }
    fputc('\n', stream);
}

static void write_witness(FILE *stream, const struct dalcs_evidence *w) {
    fprintf(stream, "      %s:", w->kind);
    for (size_t i = 0; i < w->n_entries; i++) {
        const struct dalcs_evidence_entry *e = &w->entry[i];
        fprintf(stream, " %s %.6g", e->name, e->re);
        if (e->im != 0.0) {
            fprintf(stream, "%+.6gj", e->im);
        }
    }
    fputc('\n', stream);
    for (size_t i = 0; i < w->n_rows; i++) {
        fprintf(stream, "        %-12s", w->row[i]);
        for (size_t j = 0; j < w->n_columns; j++) {
            fprintf(stream, " %12.6g", w->value[i * w->n_columns + j]);
        }
        fputc('\n', stream);
    }
}

static void write_witnesses(FILE *stream, size_t n, const struct dalcs_evidence *w) {
    for (size_t i = 0; i < n; i++) {
        write_witness(stream, &w[i]);
    }
}

/* The answer stands before the sentence already. */
static const char *without_answer(const struct dalcs_verdict *v) {
    const char *answer = dalcs_answer_text(v->answer);
    size_t n = strlen(answer);
    if (strncmp(v->sentence, answer, n) != 0) {
        return v->sentence;
    }
    return v->sentence[n] == '\0' ? "" : v->sentence[n] == ':' ? v->sentence + n + 2 : v->sentence;
}

static void write_part(FILE *stream, const struct dalcs_checked_part *part, bool all) {
    fprintf(stream, "  ");
    write_wrapped(stream, 2, 2, part->summary);
    fputc('\n', stream);
    for (size_t i = 0; i < part->n_verdicts; i++) {
        const struct dalcs_verdict *v = &part->verdict[i];
        fprintf(stream, "  %-12s %-11s ", v->question, dalcs_answer_text(v->answer));
        write_wrapped(stream, 27, 27, without_answer(v));
        fprintf(stream, "%27s[", "");
        fprintf(stream, "%s]\n", v->source);
        if (all) {
            write_witnesses(stream, v->n_witnesses, v->witness);
        }
    }
    if (!all) {
        return;
    }
    fputc('\n', stream);
    for (size_t i = 0; i < part->n_conditions; i++) {
        const struct dalcs_condition *c = &part->condition[i];
        fprintf(stream, "  %-7s %-11s ", c->id, dalcs_answer_text(c->holds));
        write_wrapped(stream, 22, 22, c->text);
        if (c->because != NULL) {
            fprintf(stream, "%22s", "");
            write_wrapped(stream, 22, 22, c->because);
        }
        fprintf(stream, "%22s[%s]\n", "", c->source);
        write_witnesses(stream, c->n_witnesses, c->witness);
    }
}

static void write_count(FILE *stream, int n, const char *singular, const char *plural) {
    fprintf(stream, ", %d %s", n, n == 1 ? singular : plural);
}

void dalcs_check_write_text(FILE *stream, const struct dalcs_check *check, bool all) {
    fprintf(stream, "%s  %s\n", check->netlist, check->title == NULL ? "" : check->title);
    for (size_t i = 0; i < check->n_parts; i++) {
        const struct dalcs_checked_part *part = &check->part[i];
        if (check->n_parts > 1 || part->n_equal > 1) {
            fprintf(stream, "\n  the part with %s", part->element);
            if (part->n_equal > 1) {
                fprintf(stream, " and %zu more exactly like it", part->n_equal - 1);
            }
            write_count(stream, part->states, "state", "states");
            write_count(stream, part->diodes, "diode", "diodes");
            fputc('\n', stream);
        }
        fputc('\n', stream);
        write_part(stream, part, all);
    }
    if (!all) {
        fputs("\n  --all shows every condition with its numbers\n", stream);
    }
    fputc('\n', stream);
}
