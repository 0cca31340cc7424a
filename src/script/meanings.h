/* meanings.h - what names mean on the cards of a run. Private to this folder. */
#ifndef DALCS_MEANINGS_H
#define DALCS_MEANINGS_H

#include "script_internal.h"

enum { DALCS_LONGEST_REWRITING = 8000 };

/* What a name means on the cards of a run. */
struct dalcs_meaning {
    const char *name;
    const char *text;  /* NULL: it cannot be measured, */
    const char *cause; /* for this */
    bool is_result;    /* of a measurement: cards refer to it by its name */
};

struct dalcs_meanings {
    struct dalcs_script *script;
    struct dalcs_meaning *meaning; /* heap */
    size_t n, capacity;
    bool is_ac;
    bool in_degrees; /* phases; the cards always have them so */
    bool out_of_memory;
};

/* A text that is read while another one is written. */
struct dalcs_rewriting {
    struct dalcs_meanings *all;
    const char *at;
    char *text; /* so far, in the arena of the statement */
    size_t n;
    const char *cause;   /* why it cannot be measured, or NULL */
    bool expects_vector; /* the word before says so */
};

/* What a name stands for; NULL: nothing that the script made. What it made before the run has a value already. */
const struct dalcs_meaning *dalcs_meanings_find(struct dalcs_meanings *all, const char *name);

/* Adds text[0..n-1]. */
void dalcs_rewriting_put(struct dalcs_rewriting *r, const char *text, size_t n);

/* Adds a text. */
void dalcs_rewriting_put_text(struct dalcs_rewriting *r, const char *text);

/* Of a name. */
bool dalcs_rewriting_is_letter(char c);

/* Of a number. */
bool dalcs_rewriting_is_digit(char c);

/* From an opening parenthesis to the closing one, both included; 0: there is none. */
size_t dalcs_rewriting_parenthesis(const char *text);

/* v(a), vdb(a,b), i(x): the text in the parentheses is no formula. */
bool dalcs_rewriting_is_signal(const char *word);

/* A phase, vp(a), ip(x), ph(...) or phase(...), is written where the script has radians as if it were. */
bool dalcs_rewriting_is_turned(const struct dalcs_rewriting *r, const char *word);

/* Reads a formula and writes it with all names replaced. */
void dalcs_rewriting_formula(struct dalcs_rewriting *r);

#endif
