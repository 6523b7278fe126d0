#!/bin/bash
# The page of whit explain --html as a browser shows it, 360 and 1200 pixels wide: it loads nothing, what its
# rays add is the pixel, a click on a ray marks it in the tree, and the slider goes through the eight stages,
# of which the last shows the pixel.
# lesson_in_browser_test.sh WHIT
set -euo pipefail
whit=$1
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ]; then
  echo "no Chromium here: the lesson is not looked at"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$whit" explain whitted --size 96x60 --pixel 53,36 --quiet --html "$folder/lesson.html" > /dev/null
cat "$folder/lesson.html" - > "$folder/checked.html" <<'HTML'
<script>
const wrong = [], say = text => wrong.push(text), element = document.documentElement;
if (element.scrollWidth > innerWidth) say(`the page is ${element.scrollWidth} of ${innerWidth} pixels wide`);
// Of sums of floats: one ulp of each ray.
const sum = document.querySelector('.sum');
if (!(sum.dataset.error <= 1e-6)) say(sum.textContent);
const line = document.querySelector('line[data-node="1"]');
line.dispatchEvent(new MouseEvent('click'));
if (!document.querySelector('details[data-node="1"]>summary.picked') || !line.classList.contains('picked')) say('a ray is not marked');
const stages = Object.keys(meanings);
for (let i = 0; i <= Number(find('step').max); ++i) {
  find('step').value = i;
  find('step').oninput();
  const expected = `${i + 1}. ${stages[i]}`;
  if (!find('stage').textContent.startsWith(expected)) say(`${find('stage').textContent}, not ${expected}`);
  if (!document.querySelector('#maps .new canvas').width) say(`${expected} shows no column`);
}
// Every column is explained where it is drawn, in letters that can be read, and a constant one says so.
document.querySelectorAll('#maps figure').forEach(figure => {
  const said = figure.querySelector('p').textContent;
  if (said.length < 8) say(`'${figure.querySelector('b').textContent}' is not explained`);
  if (getComputedStyle(figure).opacity !== '1') say(`'${said}' is pale`);
  if (figure.classList.contains('flat') !== /same at all pixels of|no pixel/.test(said)) say(`'${said}' has a picture or none`);
});
if (!document.querySelector('#maps .flat')) say('no column is constant');
// A click on a ray scrolls the list and leaves the picture where it is.
const last = [...document.querySelectorAll('line[data-node]')].at(-1), list = find('tree');
scrollTo(0, last.getBoundingClientRect().top + scrollY - 100);
const before = scrollY;
last.dispatchEvent(new MouseEvent('click'));
if (scrollY !== before) say(`a click scrolls the page by ${scrollY - before}`);
const row = document.querySelector('#tree .picked').getBoundingClientRect(), box = list.getBoundingClientRect();
if (row.top < box.top || row.bottom > box.bottom) say('the ray that was clicked is not in view');
if (![...document.styleSheets[0].cssRules].some(rule => rule.media?.mediaText === 'print' && /print-color-adjust: exact/.test(rule.cssText)))
  say('print drops colors');
const film = document.querySelector('#maps .new div').textContent;
if (film !== tree.radiance.map(digits).join(', ')) say(`the film has ${film}`);
if (/undefined|NaN|\[object/.test(document.querySelector('main').textContent)) say('a value is missing');
if (performance.getEntriesByType('resource').some(entry => !entry.name.startsWith('data:'))) say('loads something');
parent.postMessage(wrong.join('; ') || `fits ${innerWidth}`, '*');
</script>
HTML
cat > "$folder/frames.html" <<'HTML'
<pre id="found"></pre>
<script>addEventListener('message', event => found.append(event.data, '\n'));</script>
<iframe src="checked.html" style="width:360px;height:900px;border:0"></iframe>
<iframe src="checked.html" style="width:1200px;height:900px;border:0"></iframe>
HTML
found=$(timeout 120 "$browser" --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage \
  --allow-file-access-from-files --user-data-dir="$folder/profile" --virtual-time-budget=10000 \
  --dump-dom "file://$folder/frames.html" 2> "$folder/browser.log" |
  sed -n '/<pre id="found">/,/<\/pre>/p' | sed -e 's/<[^>]*>//g' -e '/^$/d' | sort)
if [ "$found" != $'fits 1200\nfits 360' ]; then
  echo "the lesson: ${found:-no answer: $(tail -n 3 "$folder/browser.log")}"
  exit 1
fi
