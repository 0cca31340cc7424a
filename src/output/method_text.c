/* method_text.c - a method and, where it has several, its stages. */
#include "method_text.h"

#include <stdio.h>
#include <string.h>

const char *dalcs_method_text(char text[DALCS_METHOD_TEXT_SIZE],
                              const struct dalcs_component_method *component) {
    if (strcmp(component->method, "radau") == 0) {
        snprintf(text, DALCS_METHOD_TEXT_SIZE, "radau, %d stage%s", component->stages,
                 component->stages == 1 ? "" : "s");
    } else {
        snprintf(text, DALCS_METHOD_TEXT_SIZE, "%s", component->method);
    }
    return text;
}
