#!/bin/bash
# The reports of whit accuracy, whit effects and whit-verify as a browser lays them out, 360, 800 and 1400
# pixels wide: every table has as many headers as cells, each cell of "Every point" stands below its header,
# nothing is wider than the page, the charts' letters can be read and do not overlap, and a click on a row or
# a point shows its picture beside the reference, in sight, and the chart stands still.
# report_in_browser_test.sh WHIT VERIFY [FOLDER]: with a folder, screenshots are kept there.
set -euo pipefail
whit=$1 verify=$2 keep=${3:-}
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ]; then
  echo "no Chromium here: the report is not looked at"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# The page that measures the report is put behind it. The report stands in a frame of the wanted width,
# because windows cannot be that narrow, and tells the page around it what is wrong.
cat > "$folder/measures.html" <<'HTML'
<script>
const wrong = [], element = document.documentElement, leastLetter = 10;
const say = text => wrong.push(text);
if (element.scrollWidth > innerWidth) say(`the page is ${element.scrollWidth} of ${innerWidth} pixels wide`);
document.querySelectorAll('details').forEach(part => part.open = true);
document.querySelectorAll('svg').forEach(chart => {
  const scale = chart.getBoundingClientRect().width / chart.viewBox.baseVal.width;
  const frame = chart.getBoundingClientRect();
  chart.querySelectorAll('text').forEach(text => {
    const letters = scale * parseFloat(getComputedStyle(text).fontSize), box = text.getBoundingClientRect();
    if (letters < leastLetter) say(`'${text.textContent}' has letters of ${letters} pixels`);
    if (box.left < frame.left || box.right > frame.right) say(`'${text.textContent}' leaves its chart`);
  });
});
document.querySelectorAll('svg').forEach(chart => {
  const texts = [...chart.querySelectorAll('text')].map(text => [text, text.getBoundingClientRect()]);
  texts.forEach(([text, a], i) => texts.slice(i + 1).forEach(([other, b]) => {
    const x = Math.min(a.right, b.right) - Math.max(a.left, b.left);
    const y = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
    if (x > 1 && y > 3) say(`'${text.textContent}' is written over '${other.textContent}'`);
  }));
});
const tables = [...document.querySelectorAll('table')];
if (data.report !== 'accuracy' && !tables.length) say('there is no table');
tables.forEach(table => {
  const counts = [...table.rows].map(row => [...row.cells].reduce((sum, cell) => sum + cell.colSpan, 0));
  if (new Set(counts).size !== 1 || table.tBodies[0].rows.length < 1) say(`rows of ${counts} cells`);
});
// The cell of the first row of "Every point" below these headers, found by their places on the page.
function cellBelow(table, group, title) {
  const groups = [...table.tHead.rows[0].cells], [, titles] = table.tHead.rows;
  const over = groups.find(cell => cell.textContent === group)?.getBoundingClientRect();
  const header = [...titles.cells].find(cell => cell.textContent === title && over &&
    cell.getBoundingClientRect().left >= over.left - 1 && cell.getBoundingClientRect().right <= over.right + 1);
  const place = header?.getBoundingClientRect();
  return [...table.tBodies[0].rows[0].cells].find(cell =>
    place && Math.abs(cell.getBoundingClientRect().left - place.left) < 1)?.textContent;
}
if (data.report === 'accuracy') {
  const heading = [...document.querySelectorAll('h3')].find(h => h.textContent === 'Every point');
  let block = heading;
  while (!block.querySelector('table')) block = block.nextElementSibling;
  const [scene] = data.scenes, [point] = scene.points, thousand = key => (point[key] / 1e3).toFixed(1);
  const expected = [['time', 'ms', point.steady_ms.toFixed(2)], ['time', 'frames', String(point.frames)],
    ['against ' + truthOf(scene), 'FLIP', point.total_flip.toFixed(5)],
    ['at equal samples', 'FLIP', point.same_samples_flip.toFixed(5)],
    ...Object.keys(point).filter(key => key.endsWith('_rays') && point[key]).map(
      key => ['thousand rays', key.replace('_rays', ''), thousand(key)])];
  expected.forEach(([group, title, value]) => {
    const found = cellBelow(block.querySelector('table'), group, title);
    if (found !== value) say(`below ${group}, ${title} stands ${found}, not ${value}`);
  });
}
// The words of columns are explained on the page.
const explained = [...document.querySelectorAll('dt')].map(term => term.textContent);
if (data.report === 'effects') document.querySelectorAll('thead th').forEach(({textContent: word}) => {
  if (!explained.includes(word)) say(`'${word}' is not explained`);
});
for (const word of data.report === 'accuracy' ? ['FLIP', 'RMSE', 'code', 'energy', 'ulp', '\u00d7 base', 'not finite'] : [])
  if (!explained.includes(word)) say(`'${word}' is not explained`);
if (/undefined|NaN|\[object/.test(document.querySelector('main').textContent)) say('a value is missing');
const links = [...document.querySelectorAll('svg a')];
if (data.report === 'accuracy' && links.length < 20) say(`${links.length} links`);
links.forEach(link => {
  const row = link.querySelector('[data-point]').dataset.point;
  const figure = document.querySelector(link.getAttribute('href'));
  link.scrollIntoView({block: 'center'});
  const {top} = link.getBoundingClientRect();
  link.dispatchEvent(new MouseEvent('click', {bubbles: true, cancelable: true, clientY: top}));
  const moved = link.getBoundingClientRect().top - top;
  if (moved) say(`${row}: the chart moves by ${moved} pixels`);
  const shown = document.querySelector('.wipe .over'), said = document.querySelector('.wipe .l');
  const place = shown.getBoundingClientRect();
  if (place.bottom <= 0 || place.top >= innerHeight) say(`${row}: its picture is out of sight`);
  if (shown.src !== figure.querySelector('img').src) say(`${row}: another picture is shown`);
  if (said.textContent !== figure.querySelector('b').textContent) say(`${row}: another name`);
  if (!shown.complete || !shown.naturalWidth) shown.decode().catch(() => say(`${row}: no picture`));
});
const loaded = performance.getEntriesByType('resource').filter(entry => !/^data:|^file:.*-[a-zA-Z]+.png$/.test(entry.name));
if (loaded.length) say(`loads ${loaded[0].name}`);
parent.postMessage(wrong.length ? wrong.join('\n') : `fits ${innerWidth}`, '*');
</script>
HTML

chrome() {
  timeout 120 "$browser" --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage \
    --hide-scrollbars --allow-file-access-from-files --user-data-dir="$folder/profile" \
    --virtual-time-budget=10000 "$@" 2> "$folder/browser.log"
}

# frame PAGE WIDTH HEIGHT
frame() { echo "<iframe src=\"$1\" style=\"border:0;width:$2px;height:$3px\"></iframe>"; }

widths=(360 800 1400) names=()
# add PAGE NAME: frames of the three widths in frames.html.
add() {
  local page=$1 name=$2 width
  cat "$page" "$folder/measures.html" > "$(dirname "$page")/$name-checked.html"
  for width in "${widths[@]}"; do
    names+=("$name at $width pixels")
    frame "$(basename "$(dirname "$page")")/$name-checked.html" "$width" 740 >> "$folder/frames.html"
    if [ -n "$keep" ]; then
      mkdir -p "$keep"
      { echo '<body style="margin:0">' && frame "file://$page" "$width" 2600; } > "$folder/frame.html"
      chrome --window-size="$width,2600" --screenshot="$keep/report-$name-$width.png" \
        "file://$folder/frame.html"
    fi
  done
}

# The script stands before the frames, so that it hears what every one of them says.
cat > "$folder/frames.html" <<'HTML'
<pre id="found"></pre><script>
const answers = {}, frames = document.getElementsByTagName('iframe');
addEventListener('message', event => {
  answers[[...frames].findIndex(frame => frame.contentWindow === event.source)] = event.data;
  document.getElementById('found').textContent = Object.entries(answers).map(
    ([number, answer]) => answer.split('\n').map(line => `${number}: ${line}\n`).join('')).join('');
});
</script>
HTML

# sweep SCENE TRUTH KNOBS
sweep() {
  local scene=$1 truth=$2
  "$whit" accuracy "$scene" --truth "$truth" --knobs "$3" --size 16x10 --time-budget 0.5 --quiet \
    --out "$folder/$truth" > /dev/null
  add "$folder/$truth/report.html" "$truth"
}
sweep mirrors model depth,cutoff,spp,packet
sweep matte transport spp,indirect
"$whit" effects --size 48x30 --frames 2 --quiet --out "$folder/effects" > /dev/null
add "$folder/effects/report.html" effects
mkdir "$folder/cases"
"$verify" --only H38,H16 --html "$folder/cases/verify.html" > /dev/null
add "$folder/cases/verify.html" verify

# Starting the browser takes longer than looking at a page: all pages are looked at at once.
found=$(chrome --dump-dom "file://$folder/frames.html" | sed -n '/<pre id="found">/,/<\/pre>/p' |
  sed 's/.*<pre id="found">//')
status=0
for i in "${!names[@]}"; do
  answer=$(grep "^$i: " <<< "$found" || true)
  if [ "$answer" != "$i: fits ${widths[i % ${#widths[@]}]}" ]; then
    echo "${names[i]}:" "${answer:-no answer: $(tail -n 3 "$folder/browser.log")}"
    status=1
  fi
done
exit $status
