# For scripts that compare pictures of the shipped scenes; to be sourced.

tableScenes() {
  echo matte whitted glass mirrors atrium landscape
  if [ -d "${WHIT_DATA:-}/crytek_sponza" ]; then echo sponza-mirror; fi
}

tableHead() {
  echo "| $1 | same codes | within one code | largest difference | RMSE |"
  echo "|---|---:|---:|---:|---:|"
}

# tableRow NAME WHIT A B: what WHIT compare says of two pictures.
tableRow() {
  "$2" compare "$3" "$4" --quiet | awk -v name="$1" '
    /^RMSE/ { rmse = $NF }
    /off by 1 or more/ { one = 100 - $(NF - 1) }
    /off by 2 or more/ { two = 100 - $(NF - 1) }
    /largest 8-bit/ { most = $NF }
    END { printf "| %s | %.4f %% | %.4f %% | %d | %s |\n", name, one, two, most, rmse }'
}
