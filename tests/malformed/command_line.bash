# What is wrong on the command line.
kind="command line"
good="../in/good.yaml --seconds 60 -o x.exr"

refuse "no command" 2 'no command; see ?etalon --help?'
refuse "empty command" 2 'unknown command ??; see ?etalon --help?' ''
refuse "unknown command" 2 'unknown command ?rendr? (did you mean ?render?\?)' rendr $good
refuse "option before the command" 2 'unknown command ?--seed?; see ?etalon --help?' --seed 3 render $good
refuse "no operand" 2 'usage: etalon render SCENE -o OUT.exr \[options]' render -o x.exr
refuse "empty operand" 2 'an empty name; usage: etalon render SCENE -o OUT.exr \[options]' render '' -o x.exr
refuse "two operands" 2 '?../in/good.yaml? is one too many; usage: etalon render SCENE -o OUT.exr \[options]' render ../in/good.yaml ../in/good.yaml -o x.exr
refuse "unknown option" 2 'unknown option ?--secnds? (did you mean ?--seconds?\?)' render $good --secnds 3
refuse "unknown letter" 2 'unknown option ?-z?; see ?etalon render --help?' render $good -z 3
refuse "an option of another command" 2 'unknown option ?--mpp?; see ?etalon info --help?' info ../in/good.yaml --mpp 3
refuse "an option without its value" 2 '--seconds needs a value: --seconds S' render ../in/good.yaml -o x.exr --seconds
refuse "-o without its value" 2 '--output needs a value: --output OUT.exr' render ../in/good.yaml --seconds 60 -o
refuse "an option in place of a value" 2 '--seconds needs a value: --seconds S' render ../in/good.yaml --seconds --mpp 3 -o x.exr
refuse "a letter in place of a value" 2 '--integrator needs a value: --integrator NAME' render ../in/good.yaml -i -o x.exr
refuse "a letter in place of a seed" 2 '--seed needs a value: --seed N' render ../in/good.yaml --seed -i pt -o x.exr
refuse "a flag with a value" 2 '--require-converged takes no value' render $good --require-converged=yes
refuse "an empty value" 2 'seed: ?? is not possible; give a whole number in \[0,9e15]' render $good --seed=
refuse "-o twice" 2 '--output is given twice: ?x.exr? and ?y.exr?' render $good -o y.exr
refuse "--stats twice" 2 '--stats is given twice: ?s.yaml? and ?t.yaml?' render $good --stats s.yaml --stats t.yaml
accept "settings twice: the last one counts" render $good --seed 2 --mpp 3 --seed 3 -i pt --spp 1
refuse "--resume twice" 2 '--resume is given twice: ?x.ck? and ?x.ck?' render $good --resume x.ck --resume x.ck
refuse "unknown setting" 2 'unknown setting ?fo?; settings are' render $good --set fo=1
refuse "--set without =" 2 '--set wants KEY=VALUE, not ?seed?' render $good --set seed
refuse "--set without a name" 2 '--set wants KEY=VALUE, not ?=3?' render $good --set =3
refuse "--set without a value" 2 'seed: ?? is not possible; give a whole number in \[0,9e15]' render $good --set seed=
refuse "a name with a blank" 2 'unknown setting ?seed ? (did you mean ?seed?\?); settings are' render $good --set 'seed =3'
refuse "a line break in a name" 2 'unknown setting ?se\?ed? (did you mean ?seed?\?); settings are' render $good --set $'se\ned=3'

kind="settings"
for value in 0 1e-400; do
    refuse "p_l of $value" 2 'large_step_probability: 0 leaves a chain where it starts; give a number in (0,1], or set allow_zero=true' render $good --large-step $value
done
for value in 2 -1 nan inf "" half 0,5 50% 1.0000001; do
    refuse "p_l of '$value'" 2 "large_step_probability: '$value' is not possible; give auto or a number in (0,1]" render $good --large-step "$value"
done
for value in -1 0 nan inf 1e10 1e-4 1h "1 2" ""; do
    refuse "budget of '$value' s" 2 "seconds: '$value' is not possible; give a number of seconds in \[0.001,1e9]" render ../in/good.yaml -o x.exr --seconds "$value"
done
for value in -1 0 nan inf 1e13 1e-7; do
    refuse "budget of '$value' mutations" 2 "mutations_per_pixel: '$value' is not possible; give a number in \[1e-6,1e12]" render ../in/good.yaml -o x.exr --mpp "$value"
done
refuse "budget without its unit" 2 'budget: ?60? is not possible; give seconds=S or mutations_per_pixel=N' render $good --set budget=60
refuse "budget of another unit" 2 'budget: ?hours=1? is not possible; give seconds=S or mutations_per_pixel=N' render $good --set budget=hours=1
for value in 0x0 0x5 1x-1 1000000x1000000 65537x1 20 20x 20x20x20 "20 x20" " 20x20" 0x10x10 2e1x20 +2x2 20X20; do
    refuse "size of '$value'" 2 "size: '$value' is not possible; give WIDTHxHEIGHT in pixels, each in \[1,65536]" render $good --size "$value"
done
refuse "a film of 4e9 pixels" 1 '../in/good.yaml:1:9: the film of 65536 x 65536 pixels is too large' render $good --size 65536x65536
for value in -1 1e9 1025 nan 1.5 99999999999999999999; do
    refuse "'$value' threads" 2 "threads: '$value' is not possible; give a count in \[0,1024]: number of threads; 0 means all (default 0)" render $good --threads "$value"
done
for value in -1 1e3 0.5 99999999999999999999 ""; do
    refuse "seed of '$value'" 2 "seed: '$value' is not possible; give a whole number in \[0,9e15]" render $good --seed "$value"
done
for value in 65 0 -2 2.5; do
    refuse "depth of '$value'" 2 "max_depth: '$value' is not possible; give -1 or a count of edges in \[1,64]" render $good --max-depth "$value"
done
for pair in chains=0 chains=1e7 chains=-5 bootstrap=0 bootstrap=1e10 start=-1 start=nan \
    start=2 start_cap=2 start_mutations=0 replicas=0 replicas=3 replicas=65 sigma=0 sigma=nan \
    sigma=1e-12 s1=0 s2=1e-13 keep_all=1 keep_all=yes allow_zero=maybe compact=yes per=wrong \
    allocation=wrong direct=wrong mode=wrong kernel=cauchy estimator=best builder=mlt \
    rule=other integrator=psmlt integrator=PT; do
    refuse "$pair" 2 "${pair%%=*}: '${pair#*=}' is not possible; give " render $good --set $pair
done
refuse "unknown integrator" 2 'integrator: ?psmlt? is not possible; give pssmlt, mmlt, pfmlt, rjmlt, smlt, mlt, bdpt, pt or auto: the algorithm (default pssmlt)' render $good -i psmlt
refuse "s1 above s2" 2 's1 (0.5) must be less than s2 (0.00390625 in large pictures)' render $good --set s1=0.5
refuse "start above start_cap" 2 'start (0.5) must not exceed start_cap (0.2)' render $good --set start=0.5
refuse "exact over a kernel without density" 2 'pfmlt in mode exact needs a kernel whose density is known: kernel=gaussian, not exponential' render $good -i pfmlt --set mode=exact --set kernel=exponential
refuse "exact by default too" 2 'pfmlt in mode exact needs a kernel whose density is known: kernel=gaussian, not exponential' render $good -i pfmlt --set kernel=exponential
refuse "weights in mode paper" 2 'pfmlt in mode paper knows no weights for large steps: estimator=plain, not kelemen' render $good -i pfmlt --set mode=paper --set estimator=kelemen
refuse "passes in a budget without room" 2 'direct=separate takes two plain samples a pixel, a quarter of all paths: give 8 mutations per pixel' render ../in/good.yaml -o x.exr -i mmlt --mpp 4 --set direct=separate
refuse "startup of pt" 2 'pt has no large steps to measure; give an integrator with chains, such as -i pssmlt' startup ../in/good.yaml -i pt
refuse "chains that do not fit into memory" 1 '../in/good.yaml:1:9: the film of 65536 x 32768 pixels is too large' render $good -i mmlt --size 65536x32768
stdout=/dev/full
for command in "info ../in/good.yaml" "compare ../in/good.exr ../in/good.exr" "startup ../in/good.yaml --mpp 1" --help; do
    tell_late "${command%% *} to a full disk" 'cannot write to standard output' $command
done
unset stdout
