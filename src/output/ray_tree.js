// The tree of rays of a pixel as nested lists, for the page of whit serve and for lessons: `tree` is that
// of pageTree() in explained_rays.h. point(node) is called when the pointer comes to a ray, point(-1) when
// it leaves.
function make(name, text, ...children) {
  const element = document.createElement(name);
  if (text !== undefined && text !== '') element.textContent = text;
  element.append(...children);
  return element;
}

function rayTree(tree, point) {
  const number = value => value.toFixed(5);
  const sample = color => {
    const mark = make('i');
    mark.style.background = color;
    return mark;
  };
  const root = make('ul');
  root.className = 'tree';
  // Adds up what each ray and all rays below it bring; children come after their parents.
  const whole = tree.nodes.map(node => [...node.adds]), sum = [0, 0, 0], lists = [];
  for (let i = tree.nodes.length - 1; i >= 0; --i) {
    const parent = tree.nodes[i].parent, to = parent === i ? sum : whole[parent];
    whole[i].forEach((value, c) => { to[c] += value; });
  }
  const most = Math.max(1, ...tree.nodes.map(node => node.codes));
  tree.nodes.forEach((node, i) => {
    const item = make('details'), bar = make('b'), share = Math.max(...whole[i]) / Math.max(...sum, 1e-30);
    bar.style.width = `${(6 * share).toFixed(2)}rem`;
    const words = make('summary', '', sample(node.color), `${node.kind}: ${node.hit}, ${node.codes} codes `, bar,
      ` ${(100 * share).toFixed(1)} %`);
    item.open = node.codes >= 0.05 * most;
    item.dataset.node = i;
    const list = make('ul', '', make('li', `adds ${node.adds.map(number).join(' ')} by itself; weight ` +
      `${node.weight}, in ${node.medium}`), ...node.lines.map(line => make('li', line)));
    item.append(words, list);
    words.addEventListener('pointerenter', () => point(i));
    words.addEventListener('pointerleave', () => point(-1));
    lists.push(list);
    (node.parent === i ? root : lists[node.parent]).append(make('li', '', item));
  });
  const facts = make('p', `codes ${tree.codes.join(' ')}, reference ${tree.reference.join(' ')}; ` +
    `rays: ${tree.nodes.length}, shadow rays: ${tree.shadowRays}`);
  const total = make('p', `sum of all rays ${sum.map(number).join(' ')}, pixel ` +
    `${tree.radiance.map(number).join(' ')}`);
  total.className = 'sum';
  total.dataset.error = Math.max(...sum.map((value, i) =>
    Math.abs(value - tree.radiance[i]) / Math.max(1e-6, tree.radiance[i])));
  const legend = make('p', '', ...(tree.legend || []).map(([name, color]) => make('span', '', sample(color), name)));
  legend.className = 'legend';
  return [facts, total, legend, root];
}
