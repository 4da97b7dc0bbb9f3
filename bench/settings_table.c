/* settings_table: prints the table of settings as Markdown, for docs/settings.md
 * (`make docs`). */

#include "base/mem.h"
#include "cli/commands.h"
#include "settings/setting.h"

#include <stdio.h>

/* Text of a cell; a bar would end it. */
static void print_cell(const char *text)
{
    for (; *text; text++)
        printf("%s%c", *text == '|' ? "\\" : "", *text);
}

/* The options of `render` that give it. */
static void print_options(const struct setting *setting)
{
    const char *before = "";
    for (int g = 0; g < ARGS_GROUPS && command_render.groups[g]; g++)
        for (const struct arg_option *o = command_render.groups[g]; o->name; o++) {
            if (o->setting == NULL || !text_equal(o->setting, setting->name))
                continue;
            if (o->letter)
                printf("%s`-%c`", before, o->letter);
            else
                printf("%s`--%s`", before, o->name);
            before = ", ";
        }
}

static void print_row(const struct setting *setting)
{
    static const char *const resumed[] = {[RESUME_SAME] = "the same",
                                          [RESUME_BUDGET] = "no less than was spent",
                                          [RESUME_FREE] = "any"};
    const char *readers = setting_readers(setting);
    struct text values = {0}, initial = {0};
    setting_values(setting, &values);
    setting_default(setting, &initial);
    printf("| `%s` | ", setting->name);
    print_options(setting);
    printf(" | ");
    print_cell(values.data);
    printf(" | ");
    print_cell(initial.data);
    printf(" | %s%s", readers, readers[0] ? ": " : "");
    print_cell(setting->help);
    printf(" | %s | `%s` |\n", resumed[setting->resume],
           setting->column ? setting->column : setting->seen);
    mem_free(values.data);
    mem_free(initial.data);
}

int main(void)
{
    puts("| key | option | values | default | meaning | resumed run | statistics |\n"
         "|---|---|---|---|---|---|---|");
    for (int i = 0; settings_row(i); i++)
        print_row(settings_row(i));
    return 0;
}
