/* embedded.h - the files that a page is made of, as make_embedded.c puts them into the program. */
#ifndef DALCS_EMBEDDED_H
#define DALCS_EMBEDDED_H

/* NUL-terminated. The library is dygraphs (https://dygraphs.com, MIT licence). */
extern const char dalcs_embedded_page_html[], dalcs_embedded_page_css[], dalcs_embedded_page_js[];
extern const char dalcs_embedded_library_css[], dalcs_embedded_library_js[];

#endif
