#!/usr/bin/env bash
# Measures success rates of the diagnosis on hidden effects. Each row is one kind of case. The seeds were not used for
# development.
#   tests/bench/gap_rows.sh                 every row; takes hours
#   tests/bench/gap_rows.sh null pair       these rows
# Writes cases and scores to erp_runs/gap_rows, and all scores so far to erp_runs/gap_rows/gap_rows.md. A row that was
# interrupted continues.
set -euo pipefail
cd "$(dirname "$0")/../.."
erp=build/release/bin/erp
out=erp_runs/gap_rows

# name           robot      kind      cases  first seed  tolerance  signals left out
rows="
single           hinge_rig  single     60    371001      0
null             hinge_rig  null      100    372001      0
withheld         hinge_rig  withheld   30    373001      0
outside          hinge_rig  outside    30    374001      0
pair             hinge_rig  pair       30    375001      0
tolerance        hinge_rig  null       40    376001      0.03
tolerance_single hinge_rig  single     40    402001      0.02
many             hinge_rig  many       40    378001      0
leg              leg        single     20    401001      0
tolerance_leg    leg        null       40    382001      0.03
many_leg         leg        many       40    383001      0
no_tension       hinge_rig  single     20    384001      0          tension
no_current       hinge_rig  single     20    385001      0          current
no_joint         hinge_rig  single     20    386001      0          joint
arm              arm        single     20    391001      0
tolerance_arm    arm        null       40    392001      0.03
many_arm         arm        many       40    393001      0
seven_dof        seven_dof  single     10    394001      0
ecce4            ecce4      single      3    395001      0
"

run_row() {  # name robot kind cases seed tolerance without
  local cases=$out/$1 truth=$out/$1.truth.json
  if [ ! -f "$truth" ]; then
    $erp gap blind make --robot "configs/$2/robot.xml" --kind "$3" --cases "$4" --seed "$5" \
      --recordings 4 --seconds 25 --tolerance "$6" --out "$cases" --truth "$truth" ${7:+--without "$7"}
  fi
  local free_run=
  [[ $1 == tolerance* || $1 == many* ]] && free_run=--free-run
  local begin_s=$SECONDS
  $erp gap blind run "$cases" ${free_run:+$free_run}
  echo $((SECONDS - begin_s)) >>"$out/$1.seconds"
  $erp gap blind score "$cases" --truth "$truth" | tee "$out/$1.score"
  $erp --version >"$out/$1.version"
}

print_scores() {  # every row that has a score, with all failed cases
  echo "# Success rates of the diagnosis on hidden effects"
  echo "Measured by \`tests/bench/gap_rows.sh\`, 4 recordings of 25 s per case."
  local name robot cases seed tolerance without
  while read -r name robot _ cases seed tolerance without; do
    [ -f "$out/$name.score" ] || continue
    echo
    echo "## $name"
    echo "$cases cases of $robot, seeds from $seed, constants with relative errors of $tolerance${without:+, without $without}; \
$(awk '{s += $1} END {print s}' "$out/$name.seconds") s on $(nproc) cores; $(cat "$out/$name.version")."
    echo '```'
    cat "$out/$name.score"
    echo '```'
  done <<<"$rows"
}

mkdir -p "$out"
all_rows=$(awk 'NF {print $1}' <<<"$rows")
for name in ${*:-$all_rows}; do
  row=$(awk -v name="$name" '$1 == name' <<<"$rows")
  if [ -z "$row" ]; then
    echo "gap_rows: unknown row \"$name\"; known rows:" $all_rows >&2
    exit 2
  fi
  # shellcheck disable=SC2086
  run_row $row
done
print_scores >"$out/gap_rows.md"
