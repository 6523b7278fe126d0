#include "accuracy/report.h"

namespace whit::accuracy {

const char* const kReportStyle = R"(
:root{color-scheme:light dark;--back:#fff;--text:#1f2328;--soft:#59636e;--line:#d8dee4;
--card:#f6f8fa;--blue:#1f5fa8;--bar:#cfe3fa;--bad:#b3261e;--good:#1a7f37}
@media(prefers-color-scheme:dark){:root{--back:#0d1117;--text:#f0f6fc;--soft:#9da7b1;
--line:#30363d;--card:#161b22;--blue:#79b8ff;--bar:#1b3a5c;--bad:#ff8b82;--good:#56d364}}
*{box-sizing:border-box}
body{margin:0;background:var(--back);color:var(--text);
font:15px/1.5 system-ui,-apple-system,"Segoe UI",sans-serif}
main{max-width:1180px;margin:0 auto;padding:1.5rem}
h1{font-size:1.9rem;margin:.2em 0}h2{font-size:1.5rem;margin:2.2em 0 .3em;padding-top:.6em;
border-top:1px solid var(--line)}h3{font-size:1.1rem;margin:1.8em 0 .5em}
p{max-width:52rem}p code{white-space:nowrap}.soft,figcaption,caption{color:var(--soft)}
nav a{margin-right:1em}a{color:var(--blue)}
.choice{font-weight:600}
.verdicts{list-style:none;padding:0}.verdicts li{margin:.25em 0;padding-left:1.7em;
text-indent:-1.7em}.holds b{color:var(--good)}.fails b{color:var(--bad)}
svg.pareto,svg.knobs,svg.causes{width:100%;height:auto;border:1px solid var(--line);border-radius:8px;
display:block}
.glance,.pair{display:grid;grid-template-columns:1fr 1fr;gap:1.2rem;align-items:start}
.glance>*,.pair>*{min-width:0}.beside{position:sticky;top:.5rem}.beside .pair{margin-top:.8rem}
.wipe{position:relative;--at:50%;border-radius:6px;overflow:hidden;line-height:0;background:#000}
.wipe img{width:100%;image-rendering:pixelated}
.wipe .over{position:absolute;inset:0;clip-path:inset(0 calc(100% - var(--at)) 0 0)}
.wipe::after{content:"";position:absolute;top:0;bottom:0;left:var(--at);width:2px;
background:#fff;mix-blend-mode:difference}
.wipe span{position:absolute;bottom:.4rem;padding:.1rem .5rem;border-radius:4px;font-size:.8rem;
line-height:1.4;background:#000a;color:#fff}.wipe .l{left:.4rem}.wipe .r{right:.4rem}
.map{width:100%;image-rendering:pixelated;border-radius:6px}
.blink .over{animation:blink 1s steps(1) infinite;clip-path:none}.blink::after{display:none}
@keyframes blink{50%{visibility:hidden}}
input[type=range]{width:100%;margin:.5em 0;accent-color:var(--blue)}
figure{margin:0}figcaption{font-size:.86rem;margin-top:.35em}
.gallery>div{display:grid;grid-template-columns:repeat(auto-fill,minmax(150px,1fr));gap:.9rem}
.gallery button{all:unset;cursor:pointer;display:block;width:100%;border-radius:6px;
padding:4px;border:1px solid transparent}
.gallery button:hover,.gallery button:focus-visible{border-color:var(--blue)}
.gallery button[aria-pressed=true]{border-color:var(--blue);background:var(--card)}
.gallery img{width:100%;border-radius:4px;display:block}
.gallery b{display:block;color:var(--text);font-weight:600;overflow-wrap:anywhere}
.gallery .front b::before{content:"\25cf  ";color:var(--blue)}
.scroll{overflow-x:auto;border:1px solid var(--line);border-radius:8px}
table{border-collapse:collapse;width:100%;font-size:.84rem;font-variant-numeric:tabular-nums}
caption{text-align:left;caption-side:bottom;font-size:.82rem;padding:.5em .7em}
th,td{padding:.28em .6em;text-align:right;white-space:nowrap}
th{font-weight:600;background:var(--card);vertical-align:bottom}
thead .groups th{text-align:center;border-left:1px solid var(--line)}
td:first-child,th:first-child{text-align:left}td.t{text-align:left;white-space:normal}
tbody tr{border-top:1px solid var(--line)}tr.front td:first-child{font-weight:600}
tr.front td:first-child::before{content:"\25cf  ";color:var(--blue)}
tr.base{background:var(--card)}td.noisy{color:var(--soft);font-style:italic}
td.bar{background:linear-gradient(to right,var(--bar) var(--v),transparent var(--v))}
td.over{color:var(--bad);font-weight:600}
.cases th,.cases td{white-space:normal;text-align:left;vertical-align:top}
.cases .broken td{color:var(--bad)}.cases code{overflow-wrap:anywhere}
details{margin:.8em 0}summary{cursor:pointer;color:var(--blue)}
dl{display:grid;grid-template-columns:fit-content(45%) minmax(0,1fr);gap:.2em 1.2em}dt{color:var(--soft)}
dd{margin:0;overflow-wrap:anywhere}.words{max-width:52rem;font-size:.92rem}label.toggle{user-select:none}
@media(max-width:760px){main{padding:.5rem}.glance,.pair{grid-template-columns:minmax(0,1fr)}
.beside{position:static}.beside .pair{grid-template-columns:1fr 1fr}
.words{grid-template-columns:1fr}.words dd{margin-bottom:.4em}}
@media print{:root{--back:#fff;--text:#000;--soft:#444;--line:#bbb;--card:#f2f2f2;--blue:#1f5fa8;
--bar:#dde9f7;--bad:#b3261e;--good:#1a7f37}main{max-width:none;padding:0}
body{font-size:10pt}table{font-size:6.4pt}th,td{padding:.15em .3em}.scroll{overflow:visible}
.screen,nav{display:none}h2{break-before:page}figure,tr,svg{break-inside:avoid}
.gallery>div{grid-template-columns:repeat(5,1fr)}
*{print-color-adjust:exact;-webkit-print-color-adjust:exact}}
)";

const char* const kReportScript = R"(
document.querySelectorAll('section').forEach(section => {
  const wipe = section.querySelector('.wipe'), range = section.querySelector('input[type=range]');
  if (!wipe) return;
  const move = () => wipe.style.setProperty('--at', range.value + '%');
  range.addEventListener('input', move);
  wipe.addEventListener('pointermove', event => {
    const box = wipe.getBoundingClientRect();
    range.value = 100 * (event.clientX - box.left) / box.width;
    move();
  });
  section.querySelector('.toggle input').addEventListener('change', event =>
    wipe.classList.toggle('blink', event.target.checked));
  const maps = section.querySelectorAll('.map');
  const buttons = section.querySelectorAll('.gallery button');
  const choose = button => {
    buttons.forEach(other => other.setAttribute('aria-pressed', other === button));
    wipe.querySelector('.over').src = button.querySelector('img').src;
    wipe.querySelector('.l').textContent = button.dataset.label;
    section.querySelector('.says').textContent = button.dataset.says;
    maps.forEach(map => {
      const source = button.dataset[map.dataset.kind];
      map.parentElement.hidden = !source;
      if (source) map.src = source;
    });
    wipe.scrollIntoView({behavior: 'smooth', block: 'nearest'});
  };
  buttons.forEach(button => button.addEventListener('click', () => choose(button)));
  // A link to a picture shows it beside the reference: from a chart, or from another file.
  const show = id => {
    const figure = id && document.getElementById(id);
    const button = figure && section.contains(figure) && figure.querySelector('button');
    if (button) choose(button);
    return Boolean(button);
  };
  section.querySelectorAll('svg a').forEach(link => link.addEventListener('click', event => {
    if (show(link.getAttribute('href').slice(1))) event.preventDefault();
  }));
  show(location.hash.slice(1));
});
)";

}  // namespace whit::accuracy
