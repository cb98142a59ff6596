//! Figures as data and layout for plotly.js.

use serde_json::{Value, json};

use crate::content::{Axis, Curve, Figure, Style};

/// Okabe and Ito's colours, distinguishable with colour blindness, without their yellow, too pale on white; names with `--` are
/// colours of the style sheet.
const COLOURS: [&str; 7] = [
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "--ink",
];

/// Of the curves of a figure by their colours, in order, so that they differ without colour too.
const STROKES: [&str; 5] = [
    "solid",
    "16px,4px",
    "16px,4px,3px,4px",
    "16px,4px,3px,4px,3px,4px",
    "28px,5px",
];
/// Of dashed curves, which are thinner: none like one of the above.
const DASHES: [&str; 5] = ["6px,4px", "2px,3px", "4px,9px", "9px,9px", "9px,3px"];
const SYMBOLS: [&str; 7] = [
    "circle",
    "square",
    "diamond",
    "triangle-up",
    "triangle-down",
    "pentagon",
    "star",
];

/// Characters of an axis title that fit below a figure, and beside it, on a phone.
const LINES: (usize, usize) = (46, 34);

/// Setting of an axis beside those of plotly.js: its `dtick` on a narrow screen.
const NARROW: &str = "narrowdtick";

/// An axis' title: what, and in which unit.
pub fn title(axis: &Axis) -> String {
    if axis.unit.is_empty() {
        axis.label.to_owned()
    } else {
        format!("{} / {}", axis.label, axis.unit)
    }
}

/// A figure for plotly.js.
pub fn plot(figure: &Figure) -> Value {
    let curves: Vec<_> = figure.curves.iter().map(|curve| trace(figure, curve)).collect();
    json!({
        "id": figure.id,
        "data": curves,
        "layout": {
            "xaxis": axis(&figure.x, LINES.0, figure.curves.iter().map(|curve| &curve.x)),
            "yaxis": axis(&figure.y, LINES.1, figure.curves.iter().map(|curve| &curve.y)),
            "font": {"family": "system-ui, sans-serif", "size": 13, "color": "--ink"},
            "paper_bgcolor": "--paper",
            "plot_bgcolor": "--paper",
            "modebar": {"color": "--faint", "activecolor": "--ink", "bgcolor": "--paper"},
            "hoverlabel": {"namelength": -1, "bgcolor": "--panel", "font": {"color": "--ink"}},
            "hovermode": "closest",
            "hoverdistance": 50,
            "showlegend": figure.curves.len() > 1,
            "legend": {"orientation": "h", "x": 0, "yref": "container", "y": 0, "yanchor": "bottom", "bgcolor": "--paper"},
        },
    })
}

/// Which of the colours a curve has, counting those alone of curves of its styles.
fn rank(figure: &Figure, curve: &Curve, styles: &[Style]) -> usize {
    let mut colours: Vec<usize> = Vec::new();
    for other in figure.curves.iter().filter(|other| styles.contains(&other.style)) {
        if !colours.contains(&other.colour) {
            colours.push(other.colour);
        }
    }
    let place = colours.iter().position(|colour| *colour == curve.colour);
    place.unwrap_or(0)
}

fn trace(figure: &Figure, curve: &Curve) -> Value {
    let colour = pick(&COLOURS, curve.colour);
    let mode = match curve.style {
        Style::Line | Style::Dashed | Style::Area => "lines",
        Style::Markers => "markers",
        Style::LineAndMarkers => "lines+markers",
    };
    let dash = match curve.style {
        Style::Dashed => pick(&DASHES, rank(figure, curve, &[Style::Dashed])),
        Style::LineAndMarkers => "solid",
        Style::Line | Style::Area | Style::Markers => pick(&STROKES, rank(figure, curve, &[Style::Line, Style::Area])),
    };
    // Points alone are hollow: what lies below them is seen.
    let (hollow, border) = if curve.style == Style::Markers {
        ("-open", 2)
    } else {
        ("", 0)
    };
    let symbol = pick(&SYMBOLS, rank(figure, curve, &[Style::Markers, Style::LineAndMarkers]));
    let mut trace = json!({
        "type": "scatter",
        "name": curve.name,
        "mode": mode,
        "x": curve.x.iter().map(|value| rounded(*value)).collect::<Vec<_>>(),
        "y": curve.y.iter().map(|value| rounded(*value)).collect::<Vec<_>>(),
        // plotly.js would leave out points, and with them the tips of peaks.
        "line": {"color": colour, "dash": dash, "width": if curve.style == Style::Dashed { 1.8 } else { 2.5 }, "simplify": false},
        "marker": {"color": colour, "symbol": format!("{symbol}{hollow}"), "size": 8, "line": {"width": border}},
        "hovertemplate": format!("{}<br>{}", hover("x", &figure.x), hover("y", &figure.y)),
    });
    if let (Style::Area, Some(trace)) = (curve.style, trace.as_object_mut()) {
        trace.insert("fill".to_owned(), json!("tozeroy"));
    }
    trace
}

/// The text shown for a coordinate of a point.
fn hover(letter: &str, axis: &Axis) -> String {
    format!("{}: %{{{letter}:.5~g}} {}", axis.label, axis.unit)
}

/// Picks from a list that starts again at its end.
fn pick(list: &[&'static str], index: usize) -> &'static str {
    list.iter()
        .cycle()
        .nth(index % list.len().max(1))
        .copied()
        .unwrap_or_default()
}

fn axis<'a>(axis: &Axis, line: usize, values: impl Iterator<Item = &'a Vec<f64>>) -> Value {
    let mut settings = json!({
        "title": {"text": broken(&title(axis), line), "standoff": 8, "font": {"size": 13}},
        "automargin": true,
        "gridcolor": "--line",
        "zerolinecolor": "--faint",
        "linecolor": "--faint",
        "tickcolor": "--faint",
        "showline": true,
        "ticks": "outside",
        "exponentformat": "power",
        "type": if axis.logarithmic { "log" } else { "linear" },
    });
    let positive = values.flatten().filter(|value| **value > 0.0);
    let (least, greatest) = positive.fold((f64::INFINITY, 0.0_f64), |(least, greatest), value| {
        (least.min(*value), greatest.max(*value))
    });
    let decades = (greatest / least).log10();
    if let (true, Some(settings)) = (axis.logarithmic, settings.as_object_mut()) {
        // Labels at powers of ten alone, about six of them; over few decades in full, at 2 and 5 too.
        let labels = match decades {
            few if few < 0.5 => json!({"tickformat": ".6~g"}),
            few if few < 1.5 => json!({"tickformat": ".6~g", "dtick": "D2"}),
            some if some < 2.5 => json!({"tickformat": ".6~g", "dtick": "D2", NARROW: 1}),
            some if some < 4.5 => json!({"tickformat": ".6~g", "dtick": 1}),
            many => json!({"dtick": (many / 6.0).ceil(), NARROW: (many / 3.0).ceil()}),
        };
        settings.extend(labels.as_object().cloned().unwrap_or_default());
    }
    settings
}

/// A title on two lines, where one would be too long.
fn broken(title: &str, line: usize) -> String {
    let middle = title.chars().count() / 2;
    let spaces = title.match_indices(' ').map(|(place, _)| place);
    let nearest = spaces.min_by_key(|place| place.abs_diff(middle));
    match nearest.and_then(|place| title.split_at_checked(place)) {
        Some((first, second)) if title.chars().count() > line => format!("{first}<br>{}", second.trim_start()),
        _ => title.to_owned(),
    }
}

/// To seven digits: enough for a figure.
fn rounded(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::content::Section;
    use crate::page::sample;

    fn plots() -> Vec<Value> {
        let sections = sample::sections();
        sections.iter().flat_map(Section::figures).map(plot).collect()
    }

    #[test]
    fn axes_and_points_have_their_units() {
        let plots = plots();
        let history = plots.iter().find(|plot| plot["id"] == "history");
        let texts = history.map(|plot| {
            [
                &plot["layout"]["yaxis"]["title"]["text"],
                &plot["data"][0]["hovertemplate"],
            ]
        });
        assert_eq!(
            texts,
            Some([
                &json!("contact force / N"),
                &json!("time: %{x:.5~g} ms<br>contact force: %{y:.5~g} N")
            ])
        );
    }

    #[test]
    fn dashed_curves_are_told_from_lines_without_colour() {
        let lengths = |dash: &str| -> Vec<u32> {
            let lengths = dash
                .split(',')
                .filter_map(|length| length.trim_end_matches("px").parse().ok());
            lengths.step_by(2).collect()
        };
        // Lines are solid or begin with a long dash; of dashed curves all dashes are equal and short.
        assert!(
            STROKES
                .iter()
                .all(|dash| lengths(dash).first().is_none_or(|length| *length >= 16))
        );
        assert!(
            DASHES
                .iter()
                .all(|dash| lengths(dash).len() == 1 && lengths(dash)[0] < 10)
        );
    }

    #[test]
    fn a_long_title_is_broken_near_its_middle() {
        assert_eq!(broken("contact force / N", 34), "contact force / N");
        assert_eq!(
            broken("processor time per simulated second / s", 34),
            "processor time per<br>simulated second / s"
        );
        assert_eq!(broken("ωωωωωωωω", 4), "ωωωωωωωω");
    }

    #[test]
    fn what_is_no_number_is_a_gap() {
        assert_eq!(
            json!([rounded(1.0 / 3.0), rounded(f64::NAN)]),
            json!([0.333_333_3, null])
        );
    }
}
