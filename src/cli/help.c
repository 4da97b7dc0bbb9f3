#include "cli/help.h"

#include "base/mem.h"
#include "integrator/registry.h"
#include "settings/setting.h"

#include <string.h>

#define WIDTH  90
#define INDENT 30

/* Text from column `column`, wrapped between INDENT and WIDTH. */
static void print_wrapped(const char *text, int column, FILE *out)
{
    if (column > INDENT - 2) {
        fputc('\n', out);
        column = 0;
    }
    fprintf(out, "%*s", INDENT - column, "");
    for (column = INDENT; *text;) {
        int word = (int)strcspn(text, " ");
        if (column > INDENT && column + 1 + word > WIDTH) {
            fprintf(out, "\n%*s", INDENT, "");
            column = INDENT;
        }
        column += fprintf(out, "%s%.*s", column > INDENT ? " " : "", word, text);
        text += word;
        text += strspn(text, " ");
    }
    fputc('\n', out);
}

static void print_option(const struct arg_option *option, FILE *out)
{
    char head[128], letter[8] = "    ";
    if (option->letter)
        snprintf(letter, sizeof letter, "-%c, ", option->letter);
    int column = snprintf(head, sizeof head, "  %s--%s%s%s", letter, option->name,
                          option->value ? " " : "", option->value ? option->value : "");
    fputs(head, out);
    print_wrapped(option->help, column, out);
}

static void print_settings(FILE *out)
{
    fputs("\nSettings, for --set and for scene files:\n", out);
    for (int i = 0; settings_row(i); i++) {
        const struct setting *setting = settings_row(i);
        struct text help = {0};
        setting_help(setting, &help);
        fprintf(out, "  %s", setting->name);
        print_wrapped(help.data, 2 + (int)strlen(setting->name), out);
        mem_free(help.data);
    }
    fputs("\nIntegrators:\n", out);
    for (int i = 0; integrator_types[i]; i++) {
        fprintf(out, "  %s", integrator_types[i]->name);
        print_wrapped(integrator_types[i]->summary,
                      2 + (int)strlen(integrator_types[i]->name), out);
    }
}

void help_command(const struct command *command, FILE *out)
{
    static const struct arg_option help = {"help", 'h', NULL, NULL, "print this"};
    fprintf(out, "usage: etalon %s %s\n\n%s\n\nOptions:\n", command->name,
            command->operands, command->summary);
    for (int g = 0; g < ARGS_GROUPS && command->groups[g]; g++)
        for (const struct arg_option *o = command->groups[g]; o->name; o++)
            print_option(o, out);
    print_option(&help, out);
    if (command->lists_settings)
        print_settings(out);
    if (command->notes)
        fprintf(out, "\n%s\n", command->notes);
}

void help_program(const struct command *const *commands, FILE *out)
{
    fputs("Etalon renders by Metropolis light transport, and sets the large-step "
          "probability\nfrom statistics that it measures while it starts.\n\n"
          "usage: etalon COMMAND ...\n\nCommands:\n",
          out);
    for (; *commands; commands++)
        fprintf(out, "  %-10s %s\n", (*commands)->name, (*commands)->summary);
    fputs("\n  etalon COMMAND --help   options of a command\n"
          "  etalon --version        version and build\n\n"
          "Exit status: 0 done, 1 failed, 2 wrong usage.\n",
          out);
}
