/* study_page.c - HTML by hand: black on white, prints on paper. */
#include "study_page.h"

#include "quantity.h"
#include "utf8.h"

void dalcs_page_begin(FILE *page, const char *title) {
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>",
          page);
    dalcs_page_text(page, title);
    fputs("</title>\n<style>\n"
          "body { font: 15px/1.45 'DejaVu Sans', Verdana, sans-serif; color: #202124; "
          "background: #fff; max-width: 62em; margin: 2em auto; padding: 0 1em; }\n"
          "h1 { font-size: 1.5em; } h2 { font-size: 1.15em; margin-top: 1.8em; }\n"
          "table { border-collapse: collapse; font-size: 0.86em; margin: 0.6em 0; }\n"
          "th, td { padding: 0.15em 0.7em; text-align: right; border-bottom: 1px solid #e3e6ea; }\n"
          "th { border-bottom: 1px solid #5f6368; vertical-align: bottom; }\n"
          "td, th { white-space: nowrap; } .t { text-align: left; white-space: normal; } .best { "
          "font-weight: bold; } .no { color: #80868b; }\n"
          "pre { font-size: 0.8em; background: #f6f7f8; padding: 0.7em; overflow-x: auto; }\n"
          "svg { max-width: 100%; height: auto; }\n"
          "@media print { body { max-width: none; font-size: 11px; } "
          "pre { white-space: pre-wrap; } table, svg { break-inside: avoid; } }\n"
          "</style>\n</head>\n<body>\n<h1>",
          page);
    dalcs_page_text(page, title);
    fputs("</h1>\n", page);
}

void dalcs_page_end(FILE *page) {
    fputs("</body>\n</html>\n", page);
}

void dalcs_page_text(FILE *page, const char *text) {
    for (const char *c = text; *c;) {
        size_t length = dalcs_utf8_length(c);
        if (*c == '<') {
            fputs("&lt;", page);
        } else if (*c == '>') {
            fputs("&gt;", page);
        } else if (*c == '&') {
            fputs("&amp;", page);
        } else if (length == 0) {
            fputs("\357\277\275", page);
        } else {
            fwrite(c, 1, length, page);
        }
        c += length > 0 ? length : 1;
    }
}

void dalcs_page_file(FILE *page, const char *title, const char *path) {
    FILE *file = fopen(path, "r");
    if (!file) {
        return;
    }
    fprintf(page, "<h2>%s</h2>\n<pre>", title);
    char line[1024];
    while (fgets(line, sizeof line, file)) {
        dalcs_page_text(page, line);
    }
    fputs("</pre>\n", page);
    fclose(file);
}

void dalcs_page_error_cell(FILE *page, double error) {
    fprintf(page, "<td>%.1e</td>", error);
}

void dalcs_page_quantity_cell(FILE *page, double value, const char *unit) {
    char text[DALCS_QUANTITY_SIZE];
    fprintf(page, "<td>%s</td>", dalcs_quantity_write(text, value, unit, 3));
}
