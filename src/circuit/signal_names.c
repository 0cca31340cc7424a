/* signal_names.c - where a signal's name begins in the text of a formula. */
#include "signal_names.h"

#include <string.h>

bool dalcs_signal_is_name_byte(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '#' ||
           c == '$' || c == '@' || (unsigned char)c >= 0x80;
}

/* "v(", "im(", ...: the bytes before the parenthesis, 0 when no signal starts here. */
int dalcs_signal_prefix(const char *t, enum dalcs_signal_part *part) {
    static const struct {
        const char *letters;
        enum dalcs_signal_part part;
    } parts[] = {{"", DALCS_PART_PLAIN},     {"m", DALCS_PART_MAGNITUDE},
                 {"db", DALCS_PART_DECIBEL}, {"p", DALCS_PART_PHASE},
                 {"ph", DALCS_PART_PHASE},   {"r", DALCS_PART_REAL},
                 {"i", DALCS_PART_IMAGINARY}};

    for (size_t k = 0; (*t == 'v' || *t == 'i') && k < sizeof parts / sizeof parts[0]; k++) {
        const size_t n = strlen(parts[k].letters);
        const size_t blanks = strncmp(t + 1, parts[k].letters, n) == 0 ? strspn(t + 1 + n, " ") : 0;
        if (strncmp(t + 1, parts[k].letters, n) == 0 && t[1 + n + blanks] == '(') {
            *part = parts[k].part;
            return (int)(1 + n + blanks);
        }
    }
    return 0;
}

/* @r1[i] or @d1[id] at t: how long it is; 0: something else. */
int dalcs_signal_device_current(const char *t) {
    int n = 1;
    while (t[0] == '@' && (dalcs_signal_is_name_byte(t[n]) || t[n] == ':')) {
        n++;
    }
    if (n > 1 && strncmp(t + n, "[id]", 4) == 0) {
        return n + 4;
    }
    return n > 1 && strncmp(t + n, "[i]", 3) == 0 ? n + 3 : 0;
}

/* mag(v(out)) and the like of .ac: the bytes before the signal, 0 when no such function starts at t. */
int dalcs_signal_part_function(const char *t, enum dalcs_signal_part *part) {
    static const struct {
        const char *name;
        enum dalcs_signal_part part;
    } functions[] = {{"mag", DALCS_PART_MAGNITUDE}, {"abs", DALCS_PART_MAGNITUDE},
                     {"db", DALCS_PART_DECIBEL},    {"ph", DALCS_PART_PHASE},
                     {"phase", DALCS_PART_PHASE},   {"re", DALCS_PART_REAL},
                     {"real", DALCS_PART_REAL},     {"im", DALCS_PART_IMAGINARY},
                     {"imag", DALCS_PART_IMAGINARY}};

    for (size_t k = 0; k < sizeof functions / sizeof functions[0]; k++) {
        const size_t n = strlen(functions[k].name);
        if (strncmp(t, functions[k].name, n) == 0 && t[n + strspn(t + n, " ")] == '(') {
            const size_t open = n + strspn(t + n, " ") + 1;
            *part = functions[k].part;
            return (int)(open + strspn(t + open, " "));
        }
    }
    return 0;
}
