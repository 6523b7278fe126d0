#!/bin/bash
# The report of whit accuracy as a browser lays it out, 360, 800 and 1400 pixels wide: nothing is wider
# than the page, the charts' letters can be read and stand on no others, and a click on a row or a point
# shows its picture beside the reference. report_in_browser_test.sh WHIT [FOLDER]: with a folder,
# screenshots are kept there.
set -euo pipefail
whit=$1 keep=${2:-}
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ]; then
  echo "no Chromium here: the report is not looked at"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# measured TRUTH KNOBS: its page as it is, and behind it what measures it. It stands in a frame of the
# wanted width, as windows cannot be that narrow, and tells what is wrong to the page around it.
measured() {
  "$whit" accuracy mirrors --truth "$1" --knobs "$2" --size 48x32 --time-budget 2 --quiet \
    --out "$folder" > /dev/null
  cat "$folder/report.html" "$folder/measures.html" > "$folder/checked.html"
}
cat > "$folder/measures.html" <<'HTML'
<script>
const wrong = [], page = document.documentElement, leastLetter = 10;
const say = text => wrong.push(text);
if (page.scrollWidth > innerWidth) say(`the page is ${page.scrollWidth} of ${innerWidth} pixels wide`);
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
const links = [...document.querySelectorAll('svg a')];
if (links.length < 20) say(`${links.length} links`);
links.forEach(link => {
  const row = link.querySelector('[data-point]').dataset.point;
  const figure = document.querySelector(link.getAttribute('href'));
  link.dispatchEvent(new MouseEvent('click', {bubbles: true, cancelable: true}));
  const shown = document.querySelector('.wipe .over'), said = document.querySelector('.wipe .l');
  if (shown.src !== figure.querySelector('img').src) say(`${row}: another picture is shown`);
  if (said.textContent !== figure.querySelector('button').dataset.label) say(`${row}: another name`);
  if (!shown.complete || !shown.naturalWidth) shown.decode().catch(() => say(`${row}: no picture`));
});
const loaded = performance.getEntriesByType('resource').filter(entry => !entry.name.startsWith('data:'));
if (loaded.length) say(`loads ${loaded[0].name}`);
parent.postMessage(wrong.length ? wrong.join('\n') : `fits ${innerWidth}`, '*');
</script>
HTML

chrome() {
  timeout 120 "$browser" --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage \
    --hide-scrollbars --allow-file-access-from-files --user-data-dir="$folder/profile" \
    --virtual-time-budget=5000 "$@" 2> "$folder/browser.log"
}

status=0
# looked TRUTH WIDTH
looked() {
  local truth=$1 width=$2 found
  cat > "$folder/frame.html" <<HTML
<body style="margin:0"><iframe src="checked.html" style="border:0;width:${width}px;height:2600px">
</iframe><pre id="found"></pre><script>
addEventListener('message', event => document.getElementById('found').textContent = event.data);
</script></body>
HTML
  found=$(chrome --dump-dom "file://$folder/frame.html" | sed -n '/<pre id="found">/,/<\/pre>/p')
  if ! grep -q "<pre id=\"found\">fits $width</pre>" <<< "$found"; then
    echo "$truth at $width pixels:" "${found:-$(tail -n 3 "$folder/browser.log")}"
    status=1
  fi
  if [ -n "$keep" ]; then
    mkdir -p "$keep"
    sed -i s/checked.html/report.html/ "$folder/frame.html"
    chrome --window-size="$width,2600" --screenshot="$keep/report-$truth-$width.png" \
      "file://$folder/frame.html"
  fi
}

measured model depth,cutoff,spp,packet
for width in 360 800 1400; do looked model $width; done
measured transport spp,indirect
for width in 360 800 1400; do looked transport $width; done
exit $status
