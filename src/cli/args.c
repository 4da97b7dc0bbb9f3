#include "cli/args.h"

#include "base/mem.h"
#include "base/text.h"

#include <ctype.h>
#include <string.h>

static const struct arg_option *find(const struct command *command, const char *name,
                                     size_t length)
{
    for (int g = 0; g < ARGS_GROUPS && command->groups[g]; g++)
        for (const struct arg_option *o = command->groups[g]; o->name; o++)
            if (strlen(o->name) == length && strncmp(o->name, name, length) == 0)
                return o;
    return NULL;
}

static const struct arg_option *find_letter(const struct command *command, char letter)
{
    for (int g = 0; g < ARGS_GROUPS && command->groups[g]; g++)
        for (const struct arg_option *o = command->groups[g]; o->name; o++)
            if (o->letter == letter)
                return o;
    return NULL;
}

static bool unknown(const struct command *command, const char *given, size_t length,
                    struct err *err)
{
    const char *names[128] = {"help"};
    size_t count = 1;
    for (int g = 0; g < ARGS_GROUPS && command->groups[g]; g++)
        for (const struct arg_option *o = command->groups[g]; o->name; o++)
            if (count + 1 < sizeof names / sizeof names[0])
                names[count++] = o->name;
    char *option = text_copy_n(given, length);
    const char *near = text_nearest(option + strspn(option, "-"), names);
    if (near)
        err_set(err, ERR_USAGE, NULL, "unknown option '%s' (did you mean '--%s'?)",
                option, near);
    else
        err_set(err, ERR_USAGE, NULL, "unknown option '%s'; see 'etalon %s --help'",
                option, command->name);
    mem_free(option);
    return false;
}

/* Of a setting the last value counts, and each definition is one of its own. Any other
 * option that is given twice is an error, as one of the two would be ignored. */
static bool is_setting(const struct arg_option *option)
{
    return option->setting || text_equal(option->name, "set") ||
           text_equal(option->name, "define");
}

static bool give(struct args *args, const struct arg_option *option, const char *value,
                 struct err *err)
{
    const char *before = args_value(args, option->name);
    if (before && option->value && !is_setting(option))
        return err_set(err, ERR_USAGE, NULL, "--%s is given twice: '%s' and '%s'",
                       option->name, before, value);
    args->given[args->given_count++] = (struct arg){option, value};
    return true;
}

/* An argument in the place of a value is an option if it begins with a dash and a letter;
 * a value of that form must be attached by '='. */
static bool is_option(const char *text)
{
    return text[0] == '-' && (text[1] == '-' || isalpha((unsigned char)text[1]));
}

/* The value of an option that stands at argv[*i]: `attached`, or the next argument. */
static bool take_value(struct args *args, const struct arg_option *option,
                       const char *attached, int argc, char *const *argv, int *i,
                       struct err *err)
{
    if (option->value == NULL) {
        if (attached)
            return err_set(err, ERR_USAGE, NULL, "--%s takes no value", option->name);
        return give(args, option, "", err);
    }
    if (attached == NULL && (*i + 1 >= argc || is_option(argv[*i + 1])))
        return err_set(err, ERR_USAGE, NULL, "--%s needs a value: --%s %s", option->name,
                       option->name, option->value);
    return give(args, option, attached ? attached : argv[++*i], err);
}

static bool take_long(struct args *args, int argc, char *const *argv, int *i,
                      struct err *err)
{
    const char *name = argv[*i] + 2, *equals = strchr(name, '=');
    size_t length = equals ? (size_t)(equals - name) : strlen(name);
    const struct arg_option *option = find(args->command, name, length);
    if (option == NULL)
        return unknown(args->command, argv[*i], length + 2, err);
    return take_value(args, option, equals ? equals + 1 : NULL, argc, argv, i, err);
}

static bool take_short(struct args *args, int argc, char *const *argv, int *i,
                       struct err *err)
{
    const char *text = argv[*i];
    const struct arg_option *option = find_letter(args->command, text[1]);
    if (option == NULL)
        return unknown(args->command, text, strlen(text), err);
    return take_value(args, option, text[2] ? text + 2 : NULL, argc, argv, i, err);
}

static bool wants_help(int argc, char *const *argv)
{
    for (int i = 0; i < argc && !text_equal(argv[i], "--"); i++)
        if (text_equal(argv[i], "--help") || text_equal(argv[i], "-h"))
            return true;
    return false;
}

static bool check_operands(const struct args *args, struct err *err)
{
    const struct command *command = args->command;
    if (args->operand_count < command->operand_count)
        return err_set(err, ERR_USAGE, NULL, "usage: etalon %s %s", command->name,
                       command->operands);
    if (args->operand_count > command->operand_count && !command->takes_more)
        return err_set(err, ERR_USAGE, NULL, "'%s' is one too many; usage: etalon %s %s",
                       args->operands[command->operand_count], command->name,
                       command->operands);
    for (int i = 0; i < args->operand_count; i++)
        if (args->operands[i][0] == '\0')
            return err_set(err, ERR_USAGE, NULL, "an empty name; usage: etalon %s %s",
                           command->name, command->operands);
    return true;
}

bool args_parse(const struct command *command, int argc, char *const *argv,
                struct args *args, struct err *err)
{
    size_t room = (size_t)argc + 1;
    *args = (struct args){.command = command, .help = wants_help(argc, argv)};
    args->given = mem_alloc(room, sizeof *args->given);
    args->operands = mem_alloc(room, sizeof *args->operands);
    if (args->help)
        return true;
    bool options = true;
    for (int i = 0; i < argc; i++) {
        const char *text = argv[i];
        bool ok = true;
        if (options && text_equal(text, "--"))
            options = false;
        else if (options && strncmp(text, "--", 2) == 0)
            ok = take_long(args, argc, argv, &i, err);
        else if (options && text[0] == '-' && text[1] != '\0')
            ok = take_short(args, argc, argv, &i, err);
        else
            args->operands[args->operand_count++] = text;
        if (!ok)
            return false;
    }
    return check_operands(args, err);
}

void args_deinit(struct args *args)
{
    mem_free(args->given);
    mem_free(args->operands);
}

const char *args_value(const struct args *args, const char *name)
{
    for (int i = args->given_count; i-- > 0;)
        if (text_equal(args->given[i].option->name, name))
            return args->given[i].value;
    return NULL;
}
