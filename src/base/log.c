#include "base/log.h"

#include "base/mem.h"
#include "base/text.h"

#include <stdarg.h>

void log_init(struct log *log)
{
    *log = (struct log){0};
}

void log_deinit(struct log *log)
{
    for (size_t i = 0; i < log->count; i++) {
        mem_free(log->notes[i].text);
        mem_free(log->notes[i].file);
    }
    mem_free(log->notes);
    log_init(log);
}

static void add(struct log *log, const struct log_note *note)
{
    for (size_t i = 0; i < log->count; i++) {
        if (text_equal(log->notes[i].text, note->text)) {
            log->notes[i].count += note->count;
            return;
        }
    }
    log->notes = mem_grow(log->notes, &log->capacity, log->count + 1, sizeof *log->notes);
    struct log_note *kept = &log->notes[log->count++];
    *kept = *note;
    kept->text = text_copy(note->text);
    kept->file = note->file ? text_copy(note->file) : NULL;
}

static void note(struct log *log, bool remark, const struct place *at, const char *format,
                 va_list args)
{
    char text[1024];
    vsnprintf(text, sizeof text, format, args);
    struct log_note note = {.text = text, .count = 1, .remark = remark};
    char *file = at && at->file ? text_copy(at->file) : NULL;
    note.file = file;
    note.line = at ? at->line : 0;
    note.col = at ? at->col : 0;
    add(log, &note);
    mem_free(file);
}

void log_note(struct log *log, const struct place *at, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    note(log, false, at, format, args);
    va_end(args);
}

void log_remark(struct log *log, const struct place *at, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    note(log, true, at, format, args);
    va_end(args);
}

size_t log_losses(const struct log *log, size_t count)
{
    size_t losses = 0;
    for (size_t i = 0; i < count && i < log->count; i++)
        losses += !log->notes[i].remark;
    return losses;
}

void log_merge(struct log *into, const struct log *from)
{
    for (size_t i = 0; i < from->count; i++)
        add(into, &from->notes[i]);
}

static void print_note(const struct log_note *note, FILE *out)
{
    struct place at = {note->file, note->line, note->col};
    struct err err = {0};
    char line[2048];
    err_set(&err, ERR_VALUE, &at, "%s", note->text);
    err_format(&err, line, (int)sizeof line);
    fprintf(out, "warning: %s", line);
    if (note->count > 1)
        fprintf(out, " (%ld times)", note->count);
    fputc('\n', out);
}

void log_print(const struct log *log, FILE *out)
{
    for (size_t i = 0; i < log->count; i++)
        print_note(&log->notes[i], out);
}

void log_print_losses(const struct log *log, size_t count, FILE *out)
{
    for (size_t i = 0; i < count && i < log->count; i++)
        if (!log->notes[i].remark)
            print_note(&log->notes[i], out);
}
