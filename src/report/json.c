/* json.c - writes JSON as it goes: commas, indentation, escapes. */
#include "json.h"

#include "utf8.h"

#include <math.h>

void dalcs_json_init(struct dalcs_json *json, FILE *stream) {
    *json = (struct dalcs_json){.stream = stream, .first = true};
    dalcs_decimal_init(&json->decimal);
}

static void write_quoted(FILE *stream, const char *text) {
    fputc('"', stream);
    for (const char *c = text; *c;) {
        size_t length = dalcs_utf8_length(c);
        unsigned char byte = (unsigned char)*c;
        if (length == 0) {
            fputs("\\ufffd", stream);
        } else if (byte == '"' || byte == '\\') {
            fprintf(stream, "\\%c", byte);
        } else if (byte < 0x20 || byte == 0x7f) {
            fprintf(stream, "\\u%04x", byte);
        } else {
            fwrite(c, 1, length, stream);
        }
        c += length == 0 ? 1 : length;
    }
    fputc('"', stream);
}

static void break_line(struct dalcs_json *json) {
    if (json->inline_depth != 0) {
        return;
    }
    fprintf(json->stream, "\n%*s", 2 * json->depth, "");
}

/* The comma, the line break and the key before a value. */
static void start_value(struct dalcs_json *json, const char *key) {
    if (json->depth > 0) {
        if (!json->first) {
            fputs(json->inline_depth != 0 ? ", " : ",", json->stream);
        }
        break_line(json);
    }
    if (key) {
        write_quoted(json->stream, key);
        fputs(": ", json->stream);
    }
    json->first = false;
}

void dalcs_json_open(struct dalcs_json *json, const char *key, char open, bool on_one_line) {
    start_value(json, key);
    fputc(open, json->stream);
    json->depth++;
    if (on_one_line && json->inline_depth == 0) {
        json->inline_depth = json->depth;
    }
    json->first = true;
}

void dalcs_json_close(struct dalcs_json *json, char close) {
    if (json->depth == json->inline_depth) {
        json->depth--;
        json->inline_depth = 0;
    } else {
        json->depth--;
        if (!json->first) {
            break_line(json);
        }
    }
    fputc(close, json->stream);
    json->first = false;
    if (json->depth == 0) {
        fputc('\n', json->stream);
    }
}

void dalcs_json_number(struct dalcs_json *json, const char *key, double value) {
    char text[DALCS_DECIMAL_SIZE];
    dalcs_decimal_write(&json->decimal, value, text);
    start_value(json, key);
    fprintf(json->stream, isfinite(value) ? "%s" : "\"%s\"", text);
}

void dalcs_json_finite(struct dalcs_json *json, const char *key, double value) {
    if (isfinite(value)) {
        dalcs_json_number(json, key, value);
    } else {
        dalcs_json_string(json, key, NULL);
    }
}

void dalcs_json_integer(struct dalcs_json *json, const char *key, long value) {
    start_value(json, key);
    fprintf(json->stream, "%ld", value);
}

void dalcs_json_boolean(struct dalcs_json *json, const char *key, bool value) {
    start_value(json, key);
    fputs(value ? "true" : "false", json->stream);
}

void dalcs_json_string(struct dalcs_json *json, const char *key, const char *text) {
    start_value(json, key);
    if (text) {
        write_quoted(json->stream, text);
    } else {
        fputs("null", json->stream);
    }
}
