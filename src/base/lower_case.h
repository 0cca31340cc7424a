/* lower_case.h - letters of ASCII, whatever the locale; of other bytes none changes. */
#ifndef DALCS_LOWER_CASE_H
#define DALCS_LOWER_CASE_H

static inline char dalcs_lower(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/* In place; returns text. */
static inline char *dalcs_lower_text(char *text) {
    for (char *c = text; *c != '\0'; c++) {
        *c = dalcs_lower(*c);
    }
    return text;
}

#endif
