/* page_json.c - numbers and texts as the script of a page reads them. */
#include "page_json.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

struct base64 {
    FILE *stream;
    unsigned char byte[3];
    int n;
};

static void flush_base64(struct base64 *base64) {
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *b = base64->byte;
    if (base64->n == 0) {
        return;
    }
    fputc(digit[b[0] >> 2], base64->stream);
    fputc(digit[(b[0] & 3) << 4 | b[1] >> 4], base64->stream);
    fputc(base64->n > 1 ? digit[(b[1] & 15) << 2 | b[2] >> 6] : '=', base64->stream);
    fputc(base64->n > 2 ? digit[b[2] & 63] : '=', base64->stream);
    base64->n = 0;
    memset(base64->byte, 0, sizeof base64->byte);
}

static void write_bytes(struct base64 *base64, uint64_t bits, int n_bytes) {
    for (int i = 0; i < n_bytes; i++) {
        base64->byte[base64->n++] = (unsigned char)(bits >> (8 * i) & 0xff);
        if (base64->n == 3) {
            flush_base64(base64);
        }
    }
}

void dalcs_page_json_column(FILE *stream, const double *value, size_t n, bool exact) {
    struct base64 base64 = {.stream = stream};
    for (size_t i = 0; i < n; i++) {
        const double drawn =
            isfinite(value[i]) ? value[i] : (double)NAN; /* infinity has no place on an axis */
        if (exact) {
            uint64_t bits = 0;
            memcpy(&bits, &drawn, sizeof bits);
            write_bytes(&base64, bits, 8);
        } else {
            float rounded = (float)drawn;
            uint32_t bits = 0;
            memcpy(&bits, &rounded, sizeof bits);
            write_bytes(&base64, bits, 4);
        }
    }
    flush_base64(&base64);
}

/* No "<" that could end the script. */
void dalcs_page_json_string(FILE *stream, const char *text) {
    fputc('"', stream);
    for (const char *c = text; *c; c++) {
        if ((unsigned char)*c < 0x20 || *c == '"' || *c == '\\' || *c == '<') {
            fprintf(stream, "\\u%04x", (unsigned char)*c);
        } else {
            fputc(*c, stream);
        }
    }
    fputc('"', stream);
}

void dalcs_page_json_number(FILE *stream, double value) {
    fprintf(stream, isfinite(value) ? "%.17g" : "null", value);
}
