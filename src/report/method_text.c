/* method_text.c - a method and, where it has several, its stages. */
#include "method_text.h"

#include <stdio.h>
#include <string.h>

bool dalcs_method_has_stages(const char *method) {
    return strcmp(method, "euler") != 0 && strcmp(method, "algebraic") != 0;
}

const char *dalcs_method_text(char text[DALCS_METHOD_TEXT_SIZE],
                              const struct dalcs_component_method *component) {
    if (dalcs_method_has_stages(component->method)) {
        snprintf(text, DALCS_METHOD_TEXT_SIZE, "%s, %d stage%s", component->method,
                 component->stages, component->stages == 1 ? "" : "s");
    } else {
        snprintf(text, DALCS_METHOD_TEXT_SIZE, "%s", component->method);
    }
    return text;
}
